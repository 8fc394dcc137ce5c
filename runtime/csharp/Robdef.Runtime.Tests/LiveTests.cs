// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using System.Threading.Tasks;
using Experimental.Arm;
using Xunit;

namespace Robdef.Runtime.Tests;

/// <summary>A client and a service, the client in C# and the service in C# or C++, over the network of this machine, in both message formats.</summary>
public sealed class LiveTests
{
    [Theory]
    [ClassData(typeof(Pairs))]
    public async Task Properties_and_functions_carry_their_values(bool isOld, bool isCpp)
    {
        using var pair = new Pair(isOld, isCpp);
        ArmStub arm = pair.Stub;
        arm.SetSpeed(2.5);
        Assert.Equal(2.5, arm.GetSpeed());
        await arm.SetSpeedAsync(3.5);
        Assert.Equal(3.5, await arm.GetSpeedAsync());
        arm.SetNote("mine");
        Assert.Equal("mine", arm.GetNote());
        Assert.Equal(7, arm.Add(3, 4));
        Assert.Equal(9, await arm.AddAsync(4, 5));
        Assert.Equal(2, arm.GetCalls());
        double[] numbers = [.. Enumerable.Range(0, 100_000).Select(i => (double)i)];
        Assert.Equal(numbers, arm.EchoedNumbers(given: numbers));
        VarValue? echo = arm.Echo(VarValue.Of(new Pose { X = 1, Label = "p" }, Pose.RrCodec));
        Assert.Equal(new Pose { X = 1, Label = "p" }, echo!.Get<Pose>());
        Assert.Null(arm.Echo(null));
    }

    [Theory]
    [ClassData(typeof(Pairs))]
    public async Task An_exception_of_the_definition_arrives_as_its_class(bool isOld, bool isCpp)
    {
        using var pair = new Pair(isOld, isCpp);
        ArmStuck stuck = Assert.Throws<ArmStuck>(() => pair.Stub.Fail("rusty"));
        Assert.Equal("rusty", stuck.Message);
        Assert.Equal("by.test", stuck.SubName);
        Assert.Equal(5.5, stuck.Parameter!.Number<double>());
        stuck = await Assert.ThrowsAsync<ArmStuck>(() => pair.Stub.FailAsync("again"));
        Assert.Equal("again", stuck.Message);
        RobdefException error = await Assert.ThrowsAsync<InvalidArgumentException>(() => pair.Stub.GetJointsAsync(4));
        Assert.Equal(ErrorCode.InvalidArgument, error.Code);
    }

    [Theory]
    [ClassData(typeof(Pairs))]
    public async Task Events_come_until_their_handler_is_taken_away(bool isOld, bool isCpp)
    {
        using var pair = new Pair(isOld, isCpp);
        var came = new TaskCompletionSource<(double, string)>(TaskCreationOptions.RunContinuationsAsynchronously);
        int count = 0;
        void Handle(double x, string label)
        {
            ++count;
            came.TrySetResult((x, label));
        }
        pair.Stub.Moved += Handle;
        Pose? moved = await pair.Stub.MoveAsync(new Pose { X = 4, Label = "home" });
        Assert.Equal(5, moved!.X);
        Assert.Equal((4, "home"), await came.Task.WaitAsync(TimeSpan.FromSeconds(20)));
        pair.Stub.Moved -= Handle;
        pair.Stub.Move(moved);
        pair.Stub.GetSpeed();
        Assert.Equal(1, count);
    }

    [Theory]
    [ClassData(typeof(Pairs))]
    public async Task Objrefs_give_stubs_of_their_types(bool isOld, bool isCpp)
    {
        using var pair = new Pair(isOld, isCpp);
        IJoint joint = await pair.Stub.GetJointsAsync(3);
        await joint.SetAngleAsync(0.25);
        Assert.Equal(0.25, pair.Stub.GetJoints(3).GetAngle());
        var same = Assert.IsType<JointStub>(await pair.Stub.GetAnythingAsync());
        Assert.Equal(0.25, same.GetAngle());
    }

    [Theory]
    [ClassData(typeof(Pairs))]
    public async Task Pipes_carry_packets_both_ways(bool isOld, bool isCpp)
    {
        using var pair = new Pair(isOld, isCpp);
        using PipeEndpoint<double> end = await pair.Stub.Samples.ConnectAsync();
        for (int i = 1; i <= 3; ++i)
        {
            end.Send(i);
        }
        List<double> came = [];
        await foreach (double packet in end)
        {
            came.Add(packet);
            if (came.Count == 3)
            {
                break;
            }
        }
        Assert.Equal([2, 4, 6], came);
        pair.Stub.Broadcast(100);
        Assert.True(end.TryReceive(TimeSpan.FromSeconds(20), out double all));
        Assert.Equal(100, all);
    }

    [Theory]
    [ClassData(typeof(Pairs))]
    public async Task Wires_hold_the_newest_value_and_tell_of_changes(bool isOld, bool isCpp)
    {
        using var pair = new Pair(isOld, isCpp);
        using WireConnection<Vector3> wire = await pair.Stub.Force.ConnectAsync();
        var changed = new TaskCompletionSource<Vector3>(TaskCreationOptions.RunContinuationsAsynchronously);
        wire.ValueChanged += (value, time) => changed.TrySetResult(value);
        wire.OutValue = new Vector3 { X = 1, Y = 2, Z = 3 };
        Assert.Equal(new Vector3 { X = 2, Y = 2, Z = 3 }, await changed.Task.WaitAsync(TimeSpan.FromSeconds(20)));
        Assert.Equal(2, wire.InValue.X);
        Assert.Equal(2, (await pair.Stub.Force.PeekInValueAsync()).Value.X);
        await pair.Stub.Force.PokeOutValueAsync(new Vector3 { X = 9 });
        Assert.Equal(9, pair.Stub.Force.PeekOutValue().Value.X);
    }

    [Theory]
    [ClassData(typeof(Pairs))]
    public async Task A_service_calls_back_the_client_that_asks(bool isOld, bool isCpp)
    {
        using var pair = new Pair(isOld, isCpp);
        pair.Stub.SetAsk(question => Task.FromResult(question * 10));
        Assert.Equal(71, await pair.Stub.AskBackAsync(7));
        pair.Stub.SetAsk(async question =>
        {
            await Task.Yield();
            throw new ArmStuck("no answer");
        });
        Assert.Equal("no answer", Assert.Throws<ArmStuck>(() => pair.Stub.AskBack(7)).Message);
        pair.Stub.SetAsk(null);
        Assert.ThrowsAny<RobdefException>(() => pair.Stub.AskBack(7));
    }

    [Theory]
    [ClassData(typeof(Pairs))]
    public async Task Memories_are_read_and_written_in_parts(bool isOld, bool isCpp)
    {
        using var pair = new Pair(isOld, isCpp);
        Assert.Equal(1000, pair.Stub.Buffer.GetLength());
        pair.Stub.Buffer.Write(10, [1, 2, 3]);
        double[] read = new double[5];
        await pair.Stub.Buffer.ReadAsync(9, read);
        Assert.Equal(new double[] { 0, 1, 2, 3, 0 }, read);
        await pair.Stub.Buffer.WriteAsync(996, new double[] { 7, 8, 9, 10 });
        await Assert.ThrowsAnyAsync<RobdefException>(() => pair.Stub.Buffer.ReadAsync(997, read));
        await pair.Stub.Buffer.ReadAsync(995, read);
        Assert.Equal(new double[] { 0, 7, 8, 9, 10 }, read);
        Assert.Equal(new long[] { 20, 30 }, await pair.Stub.Grid.GetDimsAsync());
        double[] block = new double[4];
        await pair.Stub.Grid.WriteAsync([2, 3], [2, 2], new double[] { 1, 2, 3, 4 });
        await pair.Stub.Grid.ReadAsync([3, 3], [1, 2], block.AsMemory(0, 2));
        Assert.Equal(new double[] { 2, 4 }, block[..2]);
        pair.Stub.Records.Write(4, [new Sample { Number = 7, At = [1, 2, 3] }]);
        var samples = new Sample[2];
        pair.Stub.Records.Read(3, samples);
        Assert.Equal(7u, samples[1].Number);
        Assert.Equal(new double[] { 1, 2, 3 }, samples[1].At);
    }

    [Theory]
    [ClassData(typeof(Pairs))]
    public async Task Generators_give_take_and_do_both(bool isOld, bool isCpp)
    {
        using var pair = new Pair(isOld, isCpp);
        List<int> counted = [];
        await foreach (int value in await pair.Stub.CountAsync(4))
        {
            counted.Add(value);
        }
        Assert.Equal([0, 1, 2, 3], counted);
        using (GeneratorSink<int> sink = await pair.Stub.CollectAsync())
        {
            Assert.True(await sink.NextAsync(5));
            Assert.True(sink.TryNext(6));
            sink.Close();
        }
        Assert.True(SpinWait.SpinUntil(() => pair.Stub.GetCollected().Length == 2, TimeSpan.FromSeconds(20)));
        int[] collected = await pair.Stub.GetCollectedAsync();
        Assert.Equal([5, 6], collected);
        using GeneratorFilter<int, int> twice = pair.Stub.Twice();
        Assert.True(twice.TryNext(21, out int doubled));
        Assert.Equal(42, doubled);
        Assert.Equal((true, 8), await twice.NextAsync(4));
    }

    [Fact]
    public async Task A_cancelled_call_ends_and_the_next_one_works()
    {
        using var pair = new Pair();
        using var stop = new CancellationTokenSource(50);
        await Assert.ThrowsAnyAsync<OperationCanceledException>(() => pair.Stub.WaitLongAsync(stop.Token));
        using var again = new CancellationTokenSource(50);
        Assert.ThrowsAny<OperationCanceledException>(() => pair.Stub.WaitLong(again.Token));
        Assert.Equal(3, pair.Stub.Add(1, 2));
    }

    [Fact]
    public void Calls_of_many_threads_get_their_own_answers()
    {
        using var pair = new Pair();
        Parallel.For(0, 2000, i => Assert.Equal(i + 1.0, pair.Stub.Add(i, 1)));
    }

    [Fact]
    public void A_service_that_has_ended_lets_go_of_its_object()
    {
        WeakReference arm = Serve();
        for (int i = 0; i < 100 && arm.IsAlive; ++i)
        {
            GC.Collect();
            GC.WaitForPendingFinalizers();
            Thread.Sleep(10);
        }
        Assert.False(arm.IsAlive);
    }

    private static WeakReference Serve()
    {
        using var pair = new Pair();
        Assert.Equal(3, pair.Stub.Add(1, 2));
        return new WeakReference(pair.Arm);
    }

    [Theory]
    [ClassData(typeof(Pairs))]
    public async Task Memories_of_pods_are_transferred_without_waiting(bool isOld, bool isCpp)
    {
        using var pair = new Pair(isOld, isCpp);
        Sample[] sent = [.. Enumerable.Range(0, 6).Select(i => new Sample { Number = (uint)i + 1, At = [i, 0, 1] })];
        await pair.Stub.Records.WriteAsync(2, sent);
        Sample[] came = Pods.New<Sample>(8);
        await pair.Stub.Records.ReadAsync(1, came);
        Assert.Equal([0u, 1u, 2u, 3u, 4u, 5u, 6u, 0u], came.Select(sample => sample.Number));
        Assert.Equal(5, came[6].At[0]);
        RobdefException error = await Assert.ThrowsAnyAsync<RobdefException>(() => pair.Stub.Records.ReadAsync(9, came));
        Assert.Equal(ErrorCode.OutOfRange, error.Code);
        using var stop = new CancellationTokenSource();
        stop.Cancel();
        await Assert.ThrowsAnyAsync<OperationCanceledException>(() => pair.Stub.Records.ReadAsync(1, came, stop.Token));
        // The memory goes on.
        await Task.WhenAll(Enumerable.Range(0, 50).Select(_ => pair.Stub.Records.WriteAsync(0, sent)));
        Assert.Equal(1u, (await ReadOneAsync(pair.Stub)).Number);
    }

    private static async Task<Sample> ReadOneAsync(ArmStub arm)
    {
        Sample[] one = Pods.New<Sample>(1);
        await arm.Records.ReadAsync(0, one);
        return one[0];
    }
}
