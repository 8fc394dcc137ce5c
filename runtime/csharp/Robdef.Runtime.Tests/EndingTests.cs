// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Tasks;
using Experimental.Arm;
using Xunit;

namespace Robdef.Runtime.Tests;

/// <summary>Tests that look at the whole process, beside which no other test may run.</summary>
[CollectionDefinition(Name, DisableParallelization = true)]
public static class Alone
{
    public const string Name = "alone";
}

/// <summary>
/// What is left after many sessions and cancelled calls: ROBDEF_CYCLES of them, and 300 when that is not set.
/// </summary>
[Collection(Alone.Name)]
public sealed class EndingTests
{
    private static int Cycles => int.Parse(Environment.GetEnvironmentVariable("ROBDEF_CYCLES") ?? "300", CultureInfo.InvariantCulture);

    /// <summary>What the process has.</summary>
    private sealed record Held(int Files, int Threads, long Managed, long Native, long Resident)
    {
        /// <summary>What the open files are: number and target of each, such as <c>12 socket:[4711]</c>.</summary>
        public static IEnumerable<string> OpenFiles() =>
            Directory.GetFiles("/proc/self/fd").Select(file => $"{Path.GetFileName(file)} {new FileInfo(file).LinkTarget}");

        public static Held Now()
        {
            for (int i = 0; i < 3; ++i)
            {
                GC.Collect();
                GC.WaitForPendingFinalizers();
            }
            using var process = Process.GetCurrentProcess();
            return new(Directory.GetFiles("/proc/self/fd").Length, process.Threads.Count, GC.GetTotalMemory(true), NativeHeap.InUse, process.WorkingSet64);
        }
    }

    [Theory]
    [InlineData(false)]
    [InlineData(true)]
    public async Task Sessions_that_come_and_go_leave_nothing(bool isAsync)
    {
        using var pair = new Pair();
        using var node = new Node();
        await Come(node, pair.Url, 100, isAsync);
        Held before = Held.Now();
        await Come(node, pair.Url, Cycles, isAsync);
        AssertNothingIsLeft(before);
    }

    [Fact]
    public async Task A_disposed_client_has_let_go_of_its_socket_while_its_stub_is_held()
    {
        using var pair = new Pair();
        using var node = new Node();
        await Come(node, pair.Url, 20, isAsync: false);
        int before = Held.Now().Files;
        var stubs = new List<ArmStub>();
        for (int i = 0; i < 30; ++i)
        {
            using Client<ArmStub> client = node.Connect<ArmStub>(pair.Url);
            stubs.Add(client.Root);
            client.Root.GetJoints(3).GetAngle();
        }
        int after = 0;
        Assert.True(SpinWait.SpinUntil(() => (after = Directory.GetFiles("/proc/self/fd").Length) <= before, TimeSpan.FromSeconds(20)),
            $"{before} files before, {after} after");
        foreach (ArmStub stub in stubs)
        {
            RobdefException error = Assert.ThrowsAny<RobdefException>(() => stub.GetSpeed());
            Assert.Equal(ErrorCode.ConnectionError, error.Code);
            error = await Assert.ThrowsAnyAsync<RobdefException>(() => stub.GetSpeedAsync());
            Assert.Equal(ErrorCode.ConnectionError, error.Code);
        }
    }

    [Fact]
    public async Task Calls_that_are_cancelled_at_any_moment_leave_nothing()
    {
        using var pair = new Pair();
        using var node = new Node();
        await CancelInASession(node, pair.Url, 100);
        Held before = Held.Now();
        int cancelled = await CancelInASession(node, pair.Url, Cycles);
        Assert.InRange(cancelled, 1, Cycles);
        Assert.Equal(3, pair.Stub.Add(1, 2));
        AssertNothingIsLeft(before);
    }

    /// <summary>What the README states, once the just-in-time compiler has done its best, which takes a while.</summary>
    [Fact]
    public void Calls_allocate_no_more_than_is_stated()
    {
        using var pair = new Pair();
        ArmStub arm = pair.Stub;
        AssertAllocates(0, () => arm.GetSpeed());
        AssertAllocates(0, () => arm.SetSpeed(1));
        AssertAllocates(0, () => arm.Add(1, 2));
        AssertAllocates(32, () => arm.GetNote());
    }

    private static void AssertAllocates(long most, Action call)
    {
        const int Calls = 500;
        long allocated = 0;
        Assert.True(SpinWait.SpinUntil(() =>
        {
            long before = GC.GetAllocatedBytesForCurrentThread();
            for (int i = 0; i < Calls; ++i)
            {
                call();
            }
            allocated = (GC.GetAllocatedBytesForCurrentThread() - before) / Calls;
            return allocated <= most;
        }, TimeSpan.FromSeconds(20)), $"{allocated} bytes for each call, and not {most}");
    }

    private static async Task Come(Node node, string url, int times, bool isAsync)
    {
        for (int i = 0; i < times; ++i)
        {
            if (isAsync)
            {
                await using Client<ArmStub> client = await node.ConnectAsync<ArmStub>(url);
                client.Root.Moved += (_, _) => { };
                Assert.Equal(i + 1, await client.Root.AddAsync(i, 1));
            }
            else
            {
                using Client<ArmStub> client = node.Connect<ArmStub>(url);
                using PipeEndpoint<double> end = client.Root.Samples.Connect();
                client.Root.SetAsk(Task.FromResult);
                Assert.Equal(i + 1, client.Root.Add(i, 1));
            }
        }
    }

    /// <summary>In a session of its own: until that ends, a service knows the last generators that were closed.</summary>
    private static async Task<int> CancelInASession(Node node, string url, int times)
    {
        using Client<ArmStub> client = node.Connect<ArmStub>(url);
        return await Cancel(client.Root, times);
    }

    /// <summary>How many calls were cancelled before their answers came.</summary>
    private static async Task<int> Cancel(ArmStub arm, int times)
    {
        var random = new Random(4);
        int cancelled = 0;
        for (int i = 0; i < times; ++i)
        {
            using var stop = new CancellationTokenSource();
            Task stopping = Task.Run(() =>
            {
                Thread.SpinWait(random.Next(2000));
                stop.Cancel();
            });
            try
            {
                double sum = i % 2 == 0 ? arm.Add(i, 1, stop.Token) : await arm.AddAsync(i, 1, stop.Token);
                Assert.Equal(i + 1, sum);
                using Generator<int> count = await arm.CountAsync(3, stop.Token);
                await foreach (int value in count.WithCancellation(stop.Token))
                {
                    Assert.InRange(value, 0, 2);
                }
            }
            catch (OperationCanceledException)
            {
                ++cancelled;
            }
            await stopping;
        }
        return cancelled;
    }

    private static void AssertNothingIsLeft(Held before)
    {
        // Two files more were left twice on a busy machine; why is not known, so the message names all files. What every
        // session leaves would be hundreds.
        const int others = 2;
        Held after = before;
        // Sockets are closed, sessions are forgotten, and threads of the pool end, a little later.
        Assert.True(SpinWait.SpinUntil(() =>
        {
            after = Held.Now();
            return after.Files <= before.Files + others && after.Threads <= before.Threads + 2 && after.Native < before.Native + 2_000_000;
        }, TimeSpan.FromSeconds(30)), $"{before} before, {after} after, files: {string.Join(", ", Held.OpenFiles())}");
        Assert.True(after.Managed < before.Managed + 500_000, $"{before} before, {after} after");
        // The collector keeps pages of what has long been freed, as many as its youngest generation may have.
        Assert.True(after.Resident < before.Resident + 300_000_000, $"{before} before, {after} after");
    }
}

/// <summary>What the native runtime has allocated and not freed, in all arenas.</summary>
internal static partial class NativeHeap
{
    public static long InUse
    {
        get
        {
            Counts counts = mallinfo2();
            return (long)(counts.InUse + counts.Mapped);
        }
    }

    [LibraryImport("libc.so.6")]
    private static partial Counts mallinfo2();

    [StructLayout(LayoutKind.Sequential)]
    private struct Counts
    {
        public nuint Arena;
        public nuint FreeBlocks;
        public nuint FastBlocks;
        public nuint MappedBlocks;
        public nuint Mapped;
        public nuint Unused;
        public nuint FastFree;
        public nuint InUse;
        public nuint Free;
        public nuint Top;
    }
}
