// SPDX-License-Identifier: Apache-2.0
using System;
using System.Diagnostics;
using System.Diagnostics.Metrics;
using System.Text;

namespace Robdef.Runtime;

/// <summary>One request, from its begin to its end, for <see cref="RobdefTelemetry"/>.</summary>
internal sealed class Measure
{
    private readonly Histogram<double> _durations;
    private readonly Activity? _activity;
    private readonly string _method;
    private readonly string _request;
    private readonly long _begin = Stopwatch.GetTimestamp();

    private Measure(ActivityKind kind, Histogram<double> durations, string method, string request)
    {
        _durations = durations;
        _method = method;
        _request = request;
        _activity = RobdefTelemetry.Source.StartActivity(method, kind, default(ActivityContext), Tags(null));
    }

    /// <summary>Of a stub's request; null when nothing listens. The activity of the caller stays the current one.</summary>
    public static Measure? OfCall(ObjectHandle target, ReadOnlySpan<byte> member, uint request)
    {
        if (!IsWanted(RobdefTelemetry.ClientDuration))
        {
            return null;
        }
        Activity? outer = Activity.Current;
        var measure = new Measure(ActivityKind.Client, RobdefTelemetry.ClientDuration,
            $"{target.TypeName}/{Encoding.UTF8.GetString(member)}", RequestKinds.OfCall(request));
        Activity.Current = outer;
        return measure;
    }

    /// <summary>Of a request that a handler answers; null when nothing listens. Its activity is the current one.</summary>
    public static Measure? OfRequest(ServedType type, string member, uint kind) => IsWanted(RobdefTelemetry.ServerDuration)
        ? new Measure(ActivityKind.Server, RobdefTelemetry.ServerDuration, $"{type.QualifiedName}/{member}", RequestKinds.OfRequest(kind))
        : null;

    /// <summary>The request is answered, or has failed.</summary>
    public void End(Exception? exception)
    {
        string? error = exception switch
        {
            null => null,
            RobdefException known => known.Name,
            _ => exception.GetType().FullName,
        };
        _durations.Record(Stopwatch.GetElapsedTime(_begin).TotalSeconds, Tags(error));
        if (_activity is null)
        {
            return;
        }
        if (exception is not null)
        {
            _activity.SetTag("error.type", error);
            _activity.SetStatus(ActivityStatusCode.Error, exception.Message);
        }
        // What runs in this thread beside it keeps its own activity.
        Activity? current = Activity.Current;
        _activity.Dispose();
        if (current != _activity)
        {
            Activity.Current = current;
        }
    }

    private static bool IsWanted(Histogram<double> durations) => durations.Enabled || RobdefTelemetry.Source.HasListeners();

    private TagList Tags(string? error)
    {
        var tags = new TagList
        {
            { "rpc.system.name", "robot_raconteur" },
            { "rpc.method", _method },
            { "robdef.request", _request },
        };
        if (error is not null)
        {
            tags.Add("error.type", error);
        }
        return tags;
    }
}

/// <summary>What requests are called.</summary>
internal static class RequestKinds
{
    /// <summary>By the entry type of a request (spec 01, section 5).</summary>
    public static string OfCall(uint request) => request switch
    {
        1111 => "get",
        1113 => "set",
        _ => "call",
    };

    /// <summary>By `RrRequestInfo.Kind`: RR_REQUEST_... of `rr_c/values.h`.</summary>
    public static string OfRequest(uint kind) => kind switch
    {
        1 => "get",
        2 => "set",
        5 => "objref",
        7 or 8 => "peek",
        _ => "call",
    };
}
