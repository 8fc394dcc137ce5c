// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Concurrent;
using System.Collections.Generic;
using System.Diagnostics;
using System.Diagnostics.Metrics;
using System.Linq;
using System.Threading;
using System.Threading.Tasks;
using Xunit;

namespace Robdef.Runtime.Tests;

/// <summary>Spans and measures of requests. Other tests run beside these, so each looks for its own.</summary>
public sealed class TelemetryTests : IDisposable
{
    private readonly ConcurrentQueue<Activity> _spans = [];
    private readonly ConcurrentQueue<(string Name, string Tags)> _durations = [];
    private readonly ActivityListener _listener;
    private readonly MeterListener _meters = new();

    public TelemetryTests()
    {
        _listener = new ActivityListener
        {
            ShouldListenTo = static source => source.Name == RobdefTelemetry.ActivitySourceName,
            Sample = static (ref ActivityCreationOptions<ActivityContext> _) => ActivitySamplingResult.AllDataAndRecorded,
            ActivityStopped = _spans.Enqueue,
        };
        ActivitySource.AddActivityListener(_listener);
        _meters.InstrumentPublished = static (instrument, meters) =>
        {
            if (instrument.Meter.Name == RobdefTelemetry.MeterName)
            {
                meters.EnableMeasurementEvents(instrument);
            }
        };
        _meters.SetMeasurementEventCallback<double>((instrument, seconds, tags, _) =>
        {
            Assert.InRange(seconds, 0, 60);
            _durations.Enqueue((instrument.Name, Text(tags)));
        });
        _meters.Start();
    }

    public void Dispose()
    {
        _listener.Dispose();
        _meters.Dispose();
    }

    [Fact]
    public void A_blocking_call_has_a_span_below_that_of_its_caller()
    {
        using var pair = new Pair();
        using Activity caller = new Activity("caller").Start();
        pair.Stub.SetSpeed(2);
        Assert.Equal(2, pair.Stub.GetSpeed());
        Assert.Same(caller, Activity.Current);
        List<Activity> spans = [.. _spans.Where(span => span.TraceId == caller.TraceId)];
        Assert.Equal(["set", "get"], spans.Select(static span => span.GetTagItem("robdef.request")));
        Assert.All(spans, span =>
        {
            Assert.Equal(ActivityKind.Client, span.Kind);
            Assert.Equal(caller.SpanId, span.ParentSpanId);
            Assert.Equal("experimental.arm.Arm/speed", span.DisplayName);
            Assert.Equal("experimental.arm.Arm/speed", span.GetTagItem("rpc.method"));
            Assert.Equal("robot_raconteur", span.GetTagItem("rpc.system.name"));
            Assert.Null(span.GetTagItem("error.type"));
        });
    }

    [Fact]
    public async Task An_asynchronous_call_that_fails_has_a_span_that_says_why()
    {
        using var pair = new Pair();
        using Activity caller = new Activity("caller").Start();
        Task failing = pair.Stub.FailAsync("operation");
        Assert.Same(caller, Activity.Current);
        RobdefException error = await Assert.ThrowsAnyAsync<RobdefException>(() => failing);
        Activity span = Assert.Single(_spans, span => span.TraceId == caller.TraceId);
        Assert.Equal(ActivityStatusCode.Error, span.Status);
        Assert.Equal(error.Name, span.GetTagItem("error.type"));
        Assert.Equal(error.Message, span.StatusDescription);
    }

    [Fact]
    public async Task Generators_are_measured_when_they_are_opened()
    {
        using var pair = new Pair();
        using Activity caller = new Activity("caller").Start();
        using (pair.Stub.Count(3))
        {
        }
        using (await pair.Stub.CountAsync(3))
        {
        }
        Assert.Equal(["experimental.arm.Arm/count", "experimental.arm.Arm/count"],
            _spans.Where(span => span.TraceId == caller.TraceId).Select(static span => span.DisplayName));
    }

    [Fact]
    public void A_handler_runs_in_the_span_of_its_request()
    {
        Activity? seen = null;
        using var pair = new Pair();
        pair.Arm.Wait = _ =>
        {
            seen = Activity.Current;
            return default;
        };
        pair.Stub.WaitLong();
        Assert.NotNull(seen);
        Assert.Equal(ActivityKind.Server, seen.Kind);
        Assert.Equal("experimental.arm.Arm/wait_long", seen.DisplayName);
        Assert.True(IsThere(() => _spans.Contains(seen)));
        Assert.True(seen.IsStopped);
    }

    [Fact]
    public void Durations_are_recorded_on_both_sides()
    {
        using var pair = new Pair();
        Assert.ThrowsAny<RobdefException>(() => pair.Stub.Fail("argument"));
        pair.Stub.Add(1, 2);
        foreach (string name in (string[])["rpc.client.call.duration", "rpc.server.call.duration"])
        {
            Assert.True(IsThere(() => _durations.Contains((name, "robot_raconteur experimental.arm.Arm/add call"))));
            Assert.True(IsThere(() => _durations.Any(one => one.Name == name
                && one.Tags.StartsWith("robot_raconteur experimental.arm.Arm/fail call ", StringComparison.Ordinal))));
        }
    }

    /// <summary>A service ends spans and measures after its answer has left.</summary>
    private static bool IsThere(Func<bool> holds) => SpinWait.SpinUntil(holds, TimeSpan.FromSeconds(30));

    private static string Text(ReadOnlySpan<KeyValuePair<string, object?>> tags) =>
        string.Join(' ', tags.ToArray().Select(static tag => tag.Value));
}
