// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;

namespace Robdef.Runtime;

/// <summary>How grave an entry of a node's log is.</summary>
public enum LogSeverity
{
    /// <summary>For who looks for a fault.</summary>
    Debug = 0,

    /// <summary>What usually happens.</summary>
    Info = 1,

    /// <summary>What should not happen, and did no harm.</summary>
    Warning = 2,

    /// <summary>What has failed.</summary>
    Error = 3,
}

/// <summary>How a node is made. What is not set is as the native runtime has it.</summary>
public sealed record NodeOptions
{
    /// <summary>Its name: letters, digits, `_`, `.` and `-`, a letter first.</summary>
    public string Name { get; init; } = "";

    /// <summary>Its id; a random one when empty.</summary>
    public Guid Id { get; init; }

    /// <summary>How long requests may take.</summary>
    public TimeSpan? RequestTimeout { get; init; }

    /// <summary>How long connecting may take.</summary>
    public TimeSpan? ConnectTimeout { get; init; }

    /// <summary>Clients of this node offer only the older message format.</summary>
    public bool ClientWithoutVersion4 { get; init; }

    /// <summary>Clients of this node do not offer codes for names.</summary>
    public bool ClientWithoutStringTable { get; init; }

    /// <summary>Clients of this node connect in four steps, as with services that cannot do it in one.</summary>
    public bool ClientWithoutCombinedConnect { get; init; }

    /// <summary>Capabilities that services do not offer: 1 version 4, 2 string table, 4 connecting in one step.</summary>
    public int ServerWithout { get; init; }

    /// <summary>Services offer codes for names.</summary>
    public bool ServerStringTable { get; init; }

    /// <summary>How often silent connections are tested.</summary>
    public TimeSpan? HeartbeatPeriod { get; init; }

    /// <summary>How long a client says nothing before it asks its service to keep the session.</summary>
    public TimeSpan? KeepAlivePeriod { get; init; }

    /// <summary>How long a client may say nothing before its service ends the session.</summary>
    public TimeSpan? ClientTimeout { get; init; }

    /// <summary>The largest message, in bytes.</summary>
    public int MessageSize { get; init; }

    /// <summary>The largest part of a memory in one request, in bytes.</summary>
    public int MemoryTransferLimit { get; init; }

    /// <summary>Gets each entry of the node's log: how grave it is, and the text. On any thread.</summary>
    public Action<LogSeverity, string>? Log { get; init; }

    /// <summary>
    /// Peers get type and message of exceptions that handlers of services and callbacks throw. Without it they only
    /// learn that there was one, unless it is a <see cref="RobdefException"/>; <see cref="Log"/> gets all, with the stack.
    /// </summary>
    public bool EnableDetailedErrors { get; init; }

    /// <summary>Certificates, and whom the node trusts.</summary>
    public TlsOptions? Tls { get; init; }

    /// <summary>Where what clients do is recorded.</summary>
    public AuditOptions? Audit { get; init; }

    /// <summary>
    /// Messages and wires of `rr+local` go through memory that both nodes map, where both have this; on Linux.
    /// </summary>
    public bool SharedMemory { get; init; }

    /// <summary>
    /// For so long a thread that waits for a message looks for it before it sleeps, with <see cref="SharedMemory"/> only:
    /// answers come sooner, and a processor is busy meanwhile. A millisecond at most.
    /// </summary>
    public TimeSpan Spin { get; init; }
}

/// <summary>How a client connects.</summary>
public sealed record ConnectOptions
{
    /// <summary>The user, where the service has users.</summary>
    public string UserName { get; init; } = "";

    /// <summary>The user's password.</summary>
    public string Password { get; init; } = "";

    /// <summary>What the user shows instead of a password.</summary>
    public Dictionary<string, VarValue?>? Credentials { get; init; }

    /// <summary>What the root object must be or implement, qualified; empty: what the client's stub is for.</summary>
    public string ObjectType { get; init; } = "";

    /// <summary>How long each request may take; the node's limit when not set.</summary>
    public TimeSpan? RequestTimeout { get; init; }

    /// <summary>
    /// Logs in without TLS also at a URL that discovery has found, which anybody on the network can announce. URLs from
    /// elsewhere are not asked about.
    /// </summary>
    public bool AllowClearCredentials { get; init; }

    /// <summary>
    /// Told once when the session has ended, whoever ended it: OperationAborted for this side, ConnectionError for
    /// a lost connection or a service that sends this client away, ServiceNotFound for a service that was closed.
    /// Not when connecting has failed. On a thread of the node.
    /// </summary>
    public Action<RobdefException>? Closed { get; init; }

    /// <summary>Told that the service has released the object at a path, and all below it. On a thread of the node.</summary>
    public Action<string>? PathReleased { get; init; }
}
