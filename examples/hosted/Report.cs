// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Diagnostics.Metrics;
using System.Linq;
using System.Threading;
using System.Threading.Tasks;
using Microsoft.Extensions.Hosting;
using Microsoft.Extensions.Logging;
using Robdef.Runtime;

namespace Hosted;

/// <summary>Listens to the runtime's spans and measures, and logs what there was when the host stops.</summary>
internal sealed partial class Report : IHostedService, IDisposable
{
    private readonly Lock _lock = new();
    private readonly SortedDictionary<string, (int Count, double Seconds)> _durations = [];
    private readonly ILogger _logger;
    private readonly MeterListener _meters = new();
    private readonly ActivityListener _spans;
    private long _sessions;

    public Report(ILogger<Report> logger)
    {
        _logger = logger;
        _meters.InstrumentPublished = static (instrument, listener) =>
        {
            if (instrument.Meter.Name == RobdefTelemetry.MeterName)
            {
                listener.EnableMeasurementEvents(instrument);
            }
        };
        _meters.SetMeasurementEventCallback<double>((instrument, value, tags, _) => Add(instrument, value, tags));
        _meters.SetMeasurementEventCallback<long>((_, change, _, _) => Interlocked.Add(ref _sessions, change));
        _spans = new ActivityListener
        {
            ShouldListenTo = static source => source.Name == RobdefTelemetry.ActivitySourceName,
            Sample = static (ref ActivityCreationOptions<ActivityContext> _) => ActivitySamplingResult.AllData,
            ActivityStopped = span => LogSpan(_logger, span.DisplayName, span.Status),
        };
    }

    public Task StartAsync(CancellationToken cancellationToken)
    {
        _meters.Start();
        ActivitySource.AddActivityListener(_spans);
        return Task.CompletedTask;
    }

    public Task StopAsync(CancellationToken cancellationToken)
    {
        lock (_lock)
        {
            foreach ((string request, (int count, double seconds)) in _durations)
            {
                LogDuration(_logger, request, count, seconds / count * 1e3);
            }
        }
        LogSessions(_logger, Interlocked.Read(ref _sessions));
        return Task.CompletedTask;
    }

    public void Dispose()
    {
        _meters.Dispose();
        _spans.Dispose();
    }

    [LoggerMessage(1, LogLevel.Information, "Span {Name} {Status}")]
    private static partial void LogSpan(ILogger logger, string name, ActivityStatusCode status);

    [LoggerMessage(2, LogLevel.Information, "Measured {Request}: {Count} times, {Milliseconds:F3} ms each")]
    private static partial void LogDuration(ILogger logger, string request, int count, double milliseconds);

    [LoggerMessage(3, LogLevel.Information, "Sessions now: {Count}")]
    private static partial void LogSessions(ILogger logger, long count);

    private void Add(Instrument instrument, double seconds, ReadOnlySpan<KeyValuePair<string, object?>> tags)
    {
        string request = $"{instrument.Name} {string.Join(' ', tags.ToArray().Skip(1).Select(static tag => tag.Value))}";
        lock (_lock)
        {
            (int count, double sum) = _durations.GetValueOrDefault(request);
            _durations[request] = (count + 1, sum + seconds);
        }
    }
}
