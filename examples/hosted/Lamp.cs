// SPDX-License-Identifier: Apache-2.0
using System;
using System.Threading;
using System.Threading.Tasks;
using Lab.Lamp;
using Microsoft.Extensions.Logging;
using Robdef.Runtime;

namespace Hosted;

/// <summary>The root object of the service. The host makes it, and gives it what it asks for.</summary>
internal sealed partial class Lamp(ILogger<Lamp> logger) : LampDefault
{
    private double _level;

    public override ValueTask<double> GetLevelAsync(CancellationToken cancellationToken) => new(Volatile.Read(ref _level));

    public override ValueTask SetLevelAsync(double value, CancellationToken cancellationToken)
    {
        if (value is not (>= 0 and <= 1))
        {
            throw new InvalidArgumentException($"a level is from 0 to 1, not {value}");
        }
        Change(value);
        return default;
    }

    public override async ValueTask BlinkAsync(int count, double period, CancellationToken cancellationToken)
    {
        double before = Volatile.Read(ref _level);
        TimeSpan half = TimeSpan.FromSeconds(period / 2);
        for (int i = 0; i < count; ++i)
        {
            Change(1 - before);
            await Task.Delay(half, cancellationToken).ConfigureAwait(false);
            Change(before);
            await Task.Delay(half, cancellationToken).ConfigureAwait(false);
        }
    }

    [LoggerMessage(1, LogLevel.Information, "The lamp is at {Level}")]
    private static partial void LogLevelChanged(ILogger logger, double level);

    private void Change(double level)
    {
        Volatile.Write(ref _level, level);
        LogLevelChanged(logger, level);
        FireChanged(level);
    }
}
