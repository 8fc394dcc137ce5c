// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using System.Threading.Tasks;
using Experimental.Arm;
using Xunit;

namespace Robdef.Runtime.Tests;

/// <summary>What a client that cancels leaves behind: nothing, and nothing is lost.</summary>
public sealed class CancellationTests
{
    private static readonly TimeSpan s_limit = TimeSpan.FromSeconds(20);

    [Theory]
    [ClassData(typeof(Pairs))]
    public async Task The_packet_behind_a_cancelled_loop_is_received_by_the_next(bool isOld, bool isCpp)
    {
        using var pair = new Pair(isOld, isCpp);
        using PipeEndpoint<double> end = pair.Stub.Samples.Connect();
        for (int i = 1; i <= 5; ++i)
        {
            using var stop = new CancellationTokenSource();
            ValueTask<bool> waiting = end.GetAsyncEnumerator(stop.Token).MoveNextAsync();
            Assert.False(waiting.IsCompleted);
            await stop.CancelAsync();
            await Assert.ThrowsAnyAsync<OperationCanceledException>(() => waiting.AsTask());
            end.Send(i);
            Assert.True(end.TryReceive(s_limit, out double packet));
            Assert.Equal(2 * i, packet);
        }
    }

    [Fact]
    public async Task Loops_that_are_cancelled_while_packets_come_receive_all_of_them_in_order()
    {
        const int Count = 2000;
        using var pair = new Pair();
        using PipeEndpoint<double> end = pair.Stub.Samples.Connect();
        Task sending = Task.Run(() =>
        {
            for (int i = 1; i <= Count; ++i)
            {
                end.Send(i);
                if (i % 10 == 0)
                {
                    Thread.Yield();
                }
            }
        });
        List<double> came = [];
        using var whole = new CancellationTokenSource(TimeSpan.FromSeconds(60));
        var random = new Random(7);
        while (came.Count < Count && !whole.IsCancellationRequested)
        {
            using var stop = CancellationTokenSource.CreateLinkedTokenSource(whole.Token);
            stop.CancelAfter(TimeSpan.FromMilliseconds(random.NextDouble() * 2));
            try
            {
                await foreach (double packet in end.WithCancellation(stop.Token))
                {
                    came.Add(packet);
                    if (came.Count == Count)
                    {
                        break;
                    }
                }
            }
            catch (OperationCanceledException)
            {
                // And again.
            }
        }
        await sending;
        Assert.Equal(Enumerable.Range(1, Count).Select(i => 2.0 * i), came);
    }

    [Theory]
    [InlineData(false, false)]
    [InlineData(true, false)]
    [InlineData(false, true)]
    public async Task A_generator_whose_opening_was_cancelled_is_broken_off(bool isOld, bool isBlocking)
    {
        using var pair = new Pair(isOld);
        using var isOpening = new SemaphoreSlim(0);
        using var mayOpen = new SemaphoreSlim(0);
        pair.Arm.Opening = () =>
        {
            isOpening.Release();
            Assert.True(mayOpen.Wait(s_limit));
        };
        using var stop = new CancellationTokenSource();
        Task opening = isBlocking
            ? Task.Run(() => pair.Stub.Collect(stop.Token).Dispose())
            : pair.Stub.CollectAsync(stop.Token);
        Assert.True(await isOpening.WaitAsync(s_limit));
        await stop.CancelAsync();
        await Assert.ThrowsAnyAsync<OperationCanceledException>(() => opening);
        Assert.Empty(pair.Arm.GeneratorEnds);
        mayOpen.Release();
        Assert.Equal("broken off", pair.Arm.GeneratorEnds.TryTake(out string? end, s_limit) ? end : "nothing");
        Assert.Equal(3, pair.Stub.Add(1, 2));
    }

    [Theory]
    [ClassData(typeof(Pairs))]
    public async Task A_cancelled_receive_of_a_wire_leaves_the_next_value_to_the_next(bool isOld, bool isCpp)
    {
        using var pair = new Pair(isOld, isCpp);
        using WireConnection<Vector3> wire = pair.Stub.Force.Connect();
        using var stop = new CancellationTokenSource();
        Task<WireValue<Vector3>> waiting = wire.ReceiveAsync(stop.Token);
        await stop.CancelAsync();
        await Assert.ThrowsAnyAsync<OperationCanceledException>(() => waiting);
        Task<WireValue<Vector3>> next = wire.ReceiveAsync();
        wire.OutValue = new Vector3 { X = 1 };
        Assert.Equal(2, (await next.WaitAsync(s_limit)).Value.X);
        next = wire.ReceiveAsync();
        wire.Close();
        await Assert.ThrowsAsync<RobdefInvalidOperationException>(() => next.WaitAsync(s_limit));
        await Assert.ThrowsAsync<RobdefInvalidOperationException>(() => wire.ReceiveAsync().WaitAsync(s_limit));
    }
}
