// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using Robdef.Runtime;

namespace Robdef.Hosting;

/// <summary>The running node of a host, for other services of the host.</summary>
public sealed class RobdefHost
{
    private volatile State? _state;

    /// <summary>The node.</summary>
    /// <exception cref="InvalidOperationException">The host has not started, or has stopped.</exception>
    public Node Node => Running.Node;

    /// <summary>Where it listens, with the ports that it has got.</summary>
    /// <exception cref="InvalidOperationException">The host has not started, or has stopped.</exception>
    public IReadOnlyList<string> Urls => Running.Urls;

    private State Running => _state ?? throw new InvalidOperationException("the node of the host does not run");

    internal void Begin(Node node, IReadOnlyList<string> urls) => _state = new State(node, urls);

    internal void End() => _state = null;

    private sealed record State(Node Node, IReadOnlyList<string> Urls);
}
