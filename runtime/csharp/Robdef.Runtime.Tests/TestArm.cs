// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Concurrent;
using System.Collections.Generic;
using System.Runtime.CompilerServices;
using System.Threading;
using System.Threading.Tasks;
using Experimental.Arm;

namespace Robdef.Runtime.Tests;

/// <summary>A service of all kinds of members.</summary>
internal sealed class TestArm : ArmDefault
{
    private readonly JointDefault _joint = new();
    private int _calls;

    public TestArm()
    {
        ((StoredArrayMemory<double>)Buffer).Items = new double[1000];
        ((StoredMultiDimMemory<double>)Grid).Items = new MultiDimArray<double>(20, 30);
        ((StoredArrayMemory<Sample>)Records).Items = Pods.New<Sample>(10);
        Samples.SetConnectHandler(end => end.SetHandler(packet => end.Send(packet * 2)));
        Force.SetHandler((value, time, client) => Force.Send(value with { X = value.X + 1 }));
    }

    private readonly List<int> _collected = [];

    /// <summary>Called when counting is broken off.</summary>
    public Action? CountBrokenOff { get; set; }

    /// <summary>How generators have ended: `closed`, `broken off`, or `failed`.</summary>
    public BlockingCollection<string> GeneratorEnds { get; } = [];

    public override ValueTask<int[]> GetCollectedAsync()
    {
        lock (_collected)
        {
            return new([.. _collected]);
        }
    }

    public override ValueTask BroadcastAsync(double packet)
    {
        Samples.Send(packet);
        return default;
    }

    public override ValueTask<int> GetCallsAsync() => new(_calls);

    public override ValueTask<double> AddAsync(double a, double b)
    {
        Interlocked.Increment(ref _calls);
        return new(a + b);
    }

    public override async ValueTask FailAsync(string why)
    {
        await Task.Yield();
        throw new Stuck(why, "by.test", 5.5);
    }

    public override ValueTask<Pose?> MoveAsync(Pose? target)
    {
        FireMoved(target!.X, target.Label);
        return new(target with { X = target.X + 1 });
    }

    public override async ValueTask WaitLongAsync() => await Task.Delay(2000);

    public override ValueTask<VarValue?> EchoAsync(VarValue? value) => new(value);

    public override ValueTask<double[]> NumbersAsync(double[] values) => new(values);

    public override ValueTask<Skeleton> GetJointsAsync(int index) => index == 3
        ? new(_joint)
        : throw new RobdefException(ErrorCode.InvalidArgument, "there is no such joint");

    public override ValueTask<Skeleton> GetAnythingAsync() => new(_joint);

    public override async ValueTask<int> AskBackAsync(int question) => await AskAsync(RrCurrentClient, question) + 1;

    public override IAsyncEnumerable<int> CountAsync(int limit) => Count(limit);

    /// <summary>Takes values until a negative one; -2 is a fault.</summary>
    public override async ValueTask CollectAsync(IAsyncEnumerable<int> values)
    {
        try
        {
            await foreach (int value in values)
            {
                if (value < 0)
                {
                    if (value == -2)
                    {
                        throw new Stuck("-2 is not collected");
                    }
                    return;
                }
                lock (_collected)
                {
                    _collected.Add(value);
                }
            }
            GeneratorEnds.Add("closed");
        }
        catch (OperationCanceledException)
        {
            GeneratorEnds.Add("broken off");
            throw;
        }
    }

    public override async IAsyncEnumerable<int> TwiceAsync(IAsyncEnumerable<int> values)
    {
        string end = "broken off";
        try
        {
            await foreach (int value in values)
            {
                end = "left early";
                yield return 2 * value;
                end = "broken off";
            }
            end = "closed";
        }
        finally
        {
            GeneratorEnds.Add(end);
        }
    }

    private async IAsyncEnumerable<int> Count(int limit, [EnumeratorCancellation] CancellationToken brokenOff = default)
    {
        using CancellationTokenRegistration told = brokenOff.Register(() => CountBrokenOff?.Invoke());
        try
        {
            for (int i = 0; i < limit; ++i)
            {
                await Task.Yield();
                yield return i;
            }
        }
        finally
        {
            // Whatever is to be done in order may take its time.
            await Task.Delay(20, CancellationToken.None);
            GeneratorEnds.Add(brokenOff.IsCancellationRequested ? "broken off" : "closed", CancellationToken.None);
        }
    }
}
