// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Concurrent;
using System.Collections.Generic;
using System.Threading;
using System.Threading.Tasks;

namespace Robdef.Runtime;

#pragma warning disable CA1001 // A source without a timer has nothing to dispose.
/// <summary>One session of a client with a service, as the handlers of its requests see it.</summary>
/// <param name="place">Whose members these are, for the log: `of the service ...`.</param>
/// <param name="faults">What the peer is told of exceptions.</param>
internal sealed class ServedSession(string place, Faults faults)
{
    private static readonly ConcurrentDictionary<ulong, ServedSession> s_sessions = new();

    private readonly CancellationTokenSource _ended = new();

    /// <summary>Of requests that no session has made.</summary>
    public static ServedSession None { get; } = new("", Faults.Hidden);

    /// <summary>Cancelled when nobody waits for answers any more.</summary>
    public CancellationToken Token => _ended.Token;

    /// <summary>The session of a request.</summary>
    public static ServedSession Find(ulong number) =>
        number != 0 && s_sessions.TryGetValue(number, out ServedSession? session) ? session : None;

    /// <summary>Empty outside of services.</summary>
    private string Service { get; init; } = "";

    /// <summary>A client has connected.</summary>
    public static void Begin(ulong number, string service, Faults faults)
    {
        s_sessions[number] = new ServedSession($"of the service `{service}`", faults) { Service = service };
        RobdefTelemetry.Sessions.Add(1, Tag(service));
    }

    /// <summary>The client waits no more: what its handlers do is to be broken off. They go on elsewhere than in this thread.</summary>
    public static void Leave(ulong number)
    {
        if (s_sessions.TryGetValue(number, out ServedSession? session))
        {
            _ = session.CancelQuietly();
        }
    }

    /// <summary>All of its requests have been handled.</summary>
    public static void End(ulong number)
    {
        if (s_sessions.TryRemove(number, out ServedSession? session))
        {
            RobdefTelemetry.Sessions.Add(-1, Tag(session.Service));
            _ = session.CancelQuietly();
        }
    }

    /// <summary>What the client is told of an exception that a member's handler has thrown.</summary>
    public RobdefException Tell(Exception exception, string member) =>
        faults.Tell(exception, $"the member `{member}` {place}");

    private static KeyValuePair<string, object?> Tag(string service) => new("robdef.service", service);

    private async Task CancelQuietly()
    {
        try
        {
            await _ended.CancelAsync().ConfigureAwait(false);
        }
        catch (AggregateException exception)
        {
            // Of what the program has registered.
            Unhandled.Report(exception);
        }
    }
}
#pragma warning restore CA1001
