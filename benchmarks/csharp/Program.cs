// SPDX-License-Identifier: Apache-2.0
// csharp_bench PEER: calls of a C# client beside those of a C++ client and beside a plain socket, of one service in C++,
// in turns. Prints medians of the rounds and ratios of the same round.
using System;
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
    double array = Median(Arrays, () => arm.Numbers(values));
    // The other side takes one connection at a time.
    using var raw = new Socket(AddressFamily.InterNetwork, SocketType.Stream, ProtocolType.Tcp) { NoDelay = true };
    raw.Connect(IPAddress.Loopback, int.Parse(addresses[1], CultureInfo.InvariantCulture));
    double echo = Median(Arrays, () => Echo(raw, block));
    raw.Close();
    // The first rounds are for the just-in-time compiler.
    if (round >= 0)
    {
        rows.Add([1e6 * cpp[0], 1e6 * blocking, 1e6 * asynchronous, blocking / cpp[0], asynchronous / cpp[0],
            ArrayBytes / cpp[1] / 1e6, ArrayBytes / array / 1e6, ArrayBytes / echo / 1e6, echo / array]);
    }
}
long before = GC.GetAllocatedBytesForCurrentThread();
Median(Gets, () => arm.GetSpeed());
long bytes = (GC.GetAllocatedBytesForCurrentThread() - before - (Gets * sizeof(double))) / Gets;

string[] names =
[
    "property get, C++, us", "property get, C# blocking, us", "property get, C# async, us", "blocking / C++", "async / C++",
    "10 MB there and back, C++, MB/s", "10 MB there and back, C#, MB/s", "10 MB, plain socket in C#, MB/s", "C# / plain socket",
];
for (int i = 0; i < names.Length; ++i)
{
    double[] column = [.. rows.Select(row => row[i]).Order()];
    Console.WriteLine(string.Create(CultureInfo.InvariantCulture,
        $"{names[i],-34} {column[Rounds / 2],9:F2}   ({column[0]:F2} to {column[^1]:F2})"));
}
Console.WriteLine($"{"bytes allocated for a blocking get",-34} {bytes,6}");
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

static void Echo(Socket socket, byte[] block)
{
    socket.Send(BitConverter.GetBytes((long)block.Length));
    for (int sent = 0; sent < block.Length;)
    {
        sent += socket.Send(block, sent, block.Length - sent, SocketFlags.None);
    }
    for (int received = 0; received < block.Length;)
    {
        received += socket.Receive(block, received, block.Length - received, SocketFlags.None);
    }
}
