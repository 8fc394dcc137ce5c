// SPDX-License-Identifier: Apache-2.0
using System;
using System.Threading;
using System.Threading.Tasks;
using Experimental.Arm;
using Xunit;

namespace Robdef.Runtime.Tests;

/// <summary>The token of a handler is cancelled when nobody waits for its answer any more, and not before.</summary>
public sealed class HandlerTokenTests
{
    private static readonly TimeSpan s_limit = TimeSpan.FromSeconds(20);

    /// <summary>Who ends the session of the client that waits.</summary>
    public enum Ending
    {
        Client,
        Service,
        Disconnect,
        Node,
    }

    [Theory]
    [InlineData(Ending.Client, false)]
    [InlineData(Ending.Client, true)]
    [InlineData(Ending.Service, false)]
    [InlineData(Ending.Service, true)]
    [InlineData(Ending.Disconnect, false)]
    [InlineData(Ending.Disconnect, true)]
    [InlineData(Ending.Node, false)]
    [InlineData(Ending.Node, true)]
    public async Task Whoever_ends_the_session_cancels_what_its_handlers_do(Ending ending, bool isBlocking)
    {
        var serving = new Node();
        try
        {
            var began = new TaskCompletionSource(TaskCreationOptions.RunContinuationsAsynchronously);
            var ended = new TaskCompletionSource(TaskCreationOptions.RunContinuationsAsynchronously);
            var arm = new TestArm { Wait = cancel => Wait(began, ended, isBlocking, cancel) };
            using Service service = serving.Register("arm", arm);
            string url = $"rr+tcp://127.0.0.1:{serving.Listen("rr+tcp://127.0.0.1:0")}/?service=arm";
            using var calling = new Node();
            using Client<ArmStub> client = calling.Connect<ArmStub>(url);
            Task waiting = client.Root.WaitLongAsync();
            await began.Task.WaitAsync(s_limit);
            // Another session's end is none of its business.
            using (Client<ArmStub> other = calling.Connect<ArmStub>(url))
            {
                Assert.Equal(3, other.Root.Add(1, 2));
            }
            Assert.False(ended.Task.IsCompleted);
            await Task.Run(() => End(ending, client, service, serving));
            await ended.Task.WaitAsync(s_limit);
            await Assert.ThrowsAnyAsync<RobdefException>(() => waiting.WaitAsync(s_limit));
        }
        finally
        {
            serving.Dispose();
        }
    }

    [Fact]
    public async Task The_token_of_a_call_that_is_answered_is_not_cancelled()
    {
        using var pair = new Pair();
        CancellationToken seen = default;
        pair.Arm.Wait = cancel =>
        {
            seen = cancel;
            return default;
        };
        await pair.Stub.WaitLongAsync();
        Assert.True(seen.CanBeCanceled);
        Assert.False(seen.IsCancellationRequested);
    }

    private static async ValueTask Wait(TaskCompletionSource began, TaskCompletionSource ended, bool isBlocking, CancellationToken cancel)
    {
        began.SetResult();
        try
        {
            if (isBlocking)
            {
                cancel.WaitHandle.WaitOne();
                cancel.ThrowIfCancellationRequested();
            }
            await Task.Delay(Timeout.InfiniteTimeSpan, cancel);
        }
        catch (OperationCanceledException)
        {
            ended.SetResult();
            throw;
        }
    }

    private static void End(Ending ending, Client<ArmStub> client, Service service, Node serving)
    {
        switch (ending)
        {
            case Ending.Client:
                client.Dispose();
                break;
            case Ending.Service:
                service.Close();
                break;
            case Ending.Disconnect:
                service.Disconnect(Assert.Single(service.GetClients()).Client);
                break;
            default:
                serving.Shutdown();
                break;
        }
    }
}
