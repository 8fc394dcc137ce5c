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

    /// <summary>Called when a generator that takes values is opened.</summary>
    public Action? Opening { get; set; }

    /// <summary>What `wait_long` does.</summary>
    public Func<CancellationToken, ValueTask> Wait { get; set; } = cancel => new(Task.Delay(2000, cancel));

    /// <summary>Called when counting is broken off.</summary>
    public Action? CountBrokenOff { get; set; }

    /// <summary>How generators have ended: `closed`, `broken off`, or `failed`.</summary>
    public BlockingCollection<string> GeneratorEnds { get; } = [];

    public override ValueTask<int[]> GetCollectedAsync(CancellationToken cancellationToken)
    {
        lock (_collected)
        {
            return new([.. _collected]);
        }
    }

    public override ValueTask BroadcastAsync(double packet, CancellationToken cancellationToken)
    {
        Samples.Send(packet);
        return default;
    }

    public override ValueTask<int> GetCallsAsync(CancellationToken cancellationToken) => new(_calls);

    public override ValueTask<double> AddAsync(double a, double b, CancellationToken cancellationToken)
    {
        Interlocked.Increment(ref _calls);
        return new(a + b);
    }

    public override async ValueTask FailAsync(string why, CancellationToken cancellationToken)
    {
        await Task.Yield();
        throw new ArmStuck(why, "by.test", 5.5);
    }

    public override ValueTask<Pose?> MoveAsync(Pose? target, CancellationToken cancellationToken)
    {
        FireMoved(target!.X, target.Label);
        return new(target with { X = target.X + 1 });
    }

    public override async ValueTask WaitLongAsync(CancellationToken cancellationToken) => await Wait(cancellationToken);

    public override ValueTask<VarValue?> EchoAsync(VarValue? value, CancellationToken cancellationToken) => new(value);

    public override ValueTask<double[]> EchoedNumbersAsync(double[] given, CancellationToken cancellationToken) => new(given);

    public override ValueTask<Skeleton> GetJointsAsync(int index, CancellationToken cancellationToken) => index == 3
        ? new(_joint)
        : throw new RobdefException(ErrorCode.InvalidArgument, "there is no such joint");

    public override ValueTask<Skeleton> GetAnythingAsync(CancellationToken cancellationToken) => new(_joint);

    public override async ValueTask<int> AskBackAsync(int question, CancellationToken cancellationToken) => await AskAsync(RrCurrentClient, question, cancellationToken) + 1;

    public override IAsyncEnumerable<int> CountAsync(int limit, CancellationToken cancellationToken) => Count(limit, cancellationToken);

    /// <summary>Takes values until a negative one; -2 is a fault, and -3 one of .NET.</summary>
    public override async ValueTask CollectAsync(IAsyncEnumerable<int> values, CancellationToken cancellationToken)
    {
        Opening?.Invoke();
        try
        {
            await foreach (int value in values)
            {
                if (value < 0)
                {
                    if (value == -2)
                    {
                        throw new ArmStuck("-2 is not collected");
                    }
                    if (value == -3)
                    {
                        throw new FormatException("a secret");
                    }
                    return;
                }
                lock (_collected)
                {
                    _collected.Add(value);
                }
            }
            GeneratorEnds.Add("closed", CancellationToken.None);
        }
        catch (OperationCanceledException)
        {
            GeneratorEnds.Add("broken off", CancellationToken.None);
            throw;
        }
    }

    public override async IAsyncEnumerable<int> TwiceAsync(IAsyncEnumerable<int> values, [EnumeratorCancellation] CancellationToken cancellationToken)
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
            GeneratorEnds.Add(end, CancellationToken.None);
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
