// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;

namespace Robdef.Runtime;

/// <summary>Where packets of discovery are sent and received.</summary>
[Flags]
public enum DiscoveryNetworks
{
    /// <summary>Nothing said: <see cref="LinkLocal"/>.</summary>
    None = 0,

    /// <summary>IPv6 multicast inside this machine.</summary>
    NodeLocal = 1,

    /// <summary>IPv6 multicast in the local network.</summary>
    LinkLocal = 2,

    /// <summary>IPv6 multicast in the site.</summary>
    SiteLocal = 4,

    /// <summary>IPv4 broadcasts. A node that listens hears IPv4 in any case, but asks there only with this.</summary>
    IPv4Broadcast = 8,
}

/// <summary>How a node makes itself known.</summary>
public sealed record AnnounceOptions
{
    /// <summary>Where to.</summary>
    public DiscoveryNetworks Networks { get; init; } = DiscoveryNetworks.LinkLocal;

    /// <summary>The UDP port. Nodes find those with the same port only.</summary>
    public int Port { get; init; } = 48653;

    /// <summary>Names of the interfaces to send from; empty: all that are up.</summary>
    public IReadOnlyList<string> Interfaces { get; init; } = [];

    /// <summary>From one announcement to the next: 55 s when not set, 500 ms at least.</summary>
    public TimeSpan? Period { get; init; }
}

/// <summary>How a node listens to others.</summary>
public sealed record ListenOptions
{
    /// <summary>Where.</summary>
    public DiscoveryNetworks Networks { get; init; } = DiscoveryNetworks.LinkLocal;

    /// <summary>The UDP port. Nodes find those with the same port only.</summary>
    public int Port { get; init; } = 48653;

    /// <summary>Names of the interfaces to ask at; empty: all that are up.</summary>
    public IReadOnlyList<string> Interfaces { get; init; } = [];

    /// <summary>A URL is forgotten so long after its last announcement; 60 s when not set.</summary>
    public TimeSpan? Lifetime { get; init; }

    /// <summary>Whether nodes of this machine are looked for in the files of local sockets, too.</summary>
    public bool FindsLocalNodes { get; init; } = true;

    /// <summary>Nodes that are kept; 0: 4096.</summary>
    public int MaxNodes { get; init; }

    /// <summary>Of these, nodes that one sender's address has announced first; 0: 256.</summary>
    public int MaxNodesOfSender { get; init; }
}

/// <summary>How to look for nodes and services.</summary>
public sealed record FindOptions
{
    /// <summary>`rr+tcp`, ...: other ways to reach a node are left out, and nodes without any. Empty: all.</summary>
    public IReadOnlyList<string> TransportSchemes { get; init; } = [];

    /// <summary>
    /// Nodes are asked to announce themselves, and waited for so long, before the answer is made. Zero: what is known
    /// already is used.
    /// </summary>
    public TimeSpan Wait { get; init; }

    /// <summary>How long the service indexes of all nodes may take together; 5 s when not set. What has not answered is left out.</summary>
    public TimeSpan? Timeout { get; init; }
}
