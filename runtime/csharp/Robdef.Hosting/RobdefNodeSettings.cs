// SPDX-License-Identifier: Apache-2.0
using System.Collections.Generic;
using Robdef.Runtime;

namespace Robdef.Hosting;

/// <summary>The node of a host. `Name` and `Urls` can be bound to a section of the configuration.</summary>
public sealed class RobdefNodeSettings
{
    /// <summary>Its name, which others see; that of <see cref="Options"/> when empty.</summary>
    public string Name { get; set; } = "";

    /// <summary>
    /// Where the node listens, in this order: `rr+tcp://localhost:6257` for programs of this machine, `rr+tcp://*:6257` for
    /// other machines, too; port 0 means any. None: the node only connects to others.
    /// </summary>
    public IList<string> Urls { get; } = [];

    /// <summary>All else. A `Log` of these is called beside the host's loggers.</summary>
    public NodeOptions Options { get; set; } = new();
}
