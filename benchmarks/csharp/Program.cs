// SPDX-License-Identifier: Apache-2.0
// csharp_bench PEER: calls of a C# client beside those of a C++ client and beside a plain socket, of one service in C++,
// in turns. Prints medians of the rounds and ratios of the same round.
using System;
using System.Buffers.Binary;
using System.Collections.Generic;
using System.Diagnostics;
using System.Globalization;
using System.Linq;
using System.Net;
using System.Net.Sockets;
using System.Threading.Tasks;
using Experimental.Arm;
using Robdef.Runtime;

const int Rounds = 7;
const int Gets = 3000;
const int Arrays = 10;
const int ArrayBytes = 10_000_000;

if (args.Length != 1)
{
    Console.Error.WriteLine("usage: csharp_bench PEER");
    return 2;
}
using Process peer = Start("serve");
string[] addresses = peer.StandardOutput.ReadLine()!.Split(' ');
using var node = new Node();
using Client<ArmStub> client = node.Connect<ArmStub>(addresses[0]);
ArmStub arm = client.Root;
double[] values = new double[ArrayBytes / sizeof(double)];
byte[] block = new byte[ArrayBytes];

var rows = new List<double[]>();
for (int round = -2; round < Rounds; ++round)
{
    using Process native = Start("measure", addresses);
    double[] cpp = [.. native.StandardOutput.ReadLine()!.Split(' ').Select(text => double.Parse(text, CultureInfo.InvariantCulture))];
    native.WaitForExit();
    double blocking = Median(Gets, () => arm.GetSpeed());
    double asynchronous = await MedianAsync(Gets, () => arm.GetSpeedAsync());
    double both = Median(Arrays, () => arm.Numbers(values));
    (double to, double toCpu) = MedianAndCpu(Arrays, () => arm.SetTrace(values));
    (double from, double fromCpu) = MedianAndCpu(Arrays, () => arm.GetTrace());
    // The other side takes one connection at a time.
    using var raw = new Socket(AddressFamily.InterNetwork, SocketType.Stream, ProtocolType.Tcp) { NoDelay = true };
    raw.Connect(IPAddress.Loopback, int.Parse(addresses[1], CultureInfo.InvariantCulture));
    double rawBoth = Median(Arrays, () => Move(raw, block, ArrayBytes));
    (double rawTo, double rawToCpu) = MedianAndCpu(Arrays, () => Move(raw, block, 1));
    (double rawFrom, double rawFromCpu) = MedianAndCpu(Arrays, () => Move(raw, block.AsSpan(0, 1), ArrayBytes));
    raw.Close();
    // The first rounds are for the just-in-time compiler.
    if (round >= 0)
    {
        rows.Add([1e6 * cpp[0], 1e6 * blocking, 1e6 * asynchronous, blocking / cpp[0], asynchronous / cpp[0],
            1e3 * both, 1e3 * to, 1e3 * from, rawBoth / both, rawTo / to, rawFrom / from,
            cpp[4] / cpp[1], cpp[5] / cpp[2], cpp[6] / cpp[3], 1e3 * toCpu, 1e3 * rawToCpu, 1e3 * fromCpu, 1e3 * rawFromCpu]);
    }
}
long before = GC.GetAllocatedBytesForCurrentThread();
Median(Gets, () => arm.GetSpeed());
long bytes = (GC.GetAllocatedBytesForCurrentThread() - before - (Gets * sizeof(double))) / Gets;

string[] names =
[
    "property get, C++, us", "property get, C# blocking, us", "property get, C# async, us", "blocking / C++", "async / C++",
    "10 MB there and back, C#, ms", "10 MB to the service, C#, ms", "10 MB from the service, C#, ms",
    "there and back, C# / plain socket", "to the service, C# / plain socket", "from the service, C# / plain socket",
    "the same in C++: there and back", "to the service", "from the service",
    "CPU time of the client, to the service, C#, ms", "plain socket, ms", "from the service, C#, ms", "plain socket, ms",
];
for (int i = 0; i < names.Length; ++i)
{
    double[] column = [.. rows.Select(row => row[i]).Order()];
    Console.WriteLine(string.Create(CultureInfo.InvariantCulture,
        $"{names[i],-46} {column[Rounds / 2],9:F2}   ({column[0]:F2} to {column[^1]:F2})"));
}
Console.WriteLine($"{"bytes allocated for a blocking get",-46} {bytes,6}");
peer.StandardInput.Close();
peer.WaitForExit();
return 0;

Process Start(string verb, params string[] more) =>
    Process.Start(new ProcessStartInfo(args[0], [verb, .. more]) { RedirectStandardInput = true, RedirectStandardOutput = true })!;

static double Median(int count, Action call)
{
    double[] times = new double[count];
    for (int i = 0; i < count; ++i)
    {
        long begin = Stopwatch.GetTimestamp();
        call();
        times[i] = Stopwatch.GetElapsedTime(begin).TotalSeconds;
    }
    Array.Sort(times);
    return times[count / 2];
}

// The CPU time of this process, its garbage collector included, is what other programs disturb least.
static (double Median, double Cpu) MedianAndCpu(int count, Action call)
{
    TimeSpan before = Environment.CpuUsage.TotalTime;
    double median = Median(count, call);
    return (median, (Environment.CpuUsage.TotalTime - before).TotalSeconds / count);
}

static async Task<double> MedianAsync<T>(int count, Func<Task<T>> call)
{
    double[] times = new double[count];
    for (int i = 0; i < count; ++i)
    {
        long begin = Stopwatch.GetTimestamp();
        await call();
        times[i] = Stopwatch.GetElapsedTime(begin).TotalSeconds;
    }
    Array.Sort(times);
    return times[count / 2];
}

// Sends a block, and receives another one as a program has to that keeps it: in an array of its own.
static void Move(Socket socket, ReadOnlySpan<byte> block, int wanted)
{
    Span<byte> sizes = stackalloc byte[16];
    BinaryPrimitives.WriteInt64LittleEndian(sizes, block.Length);
    BinaryPrimitives.WriteInt64LittleEndian(sizes[8..], wanted);
    socket.Send(sizes);
    while (!block.IsEmpty)
    {
        block = block[socket.Send(block)..];
    }
    for (Span<byte> room = GC.AllocateUninitializedArray<byte>(wanted); !room.IsEmpty;)
    {
        room = room[socket.Receive(room)..];
    }
}
