// SPDX-License-Identifier: Apache-2.0
using System.Diagnostics;
using System.Diagnostics.Metrics;

namespace Robdef.Runtime;

/// <summary>
/// What the runtime reports to .NET's own diagnostics: a span for each request (`ActivitySource`) and measures of them
/// (`Meter`), with the names of OpenTelemetry's conventions for remote calls. Requests are neither timed nor counted while
/// nothing listens. Wires, pipes, events, callbacks, memories and steps of generators are not reported.
/// </summary>
/// <remarks>
/// Tags of spans and durations: `rpc.system.name` is `robot_raconteur`, `rpc.method` is `example.arm.Arm/speed`,
/// `robdef.request` is `get`, `set`, `call`, `objref` or `peek`; of failures `error.type`, the name of the error on the wire, or the type
/// of the exception.
/// </remarks>
public static class RobdefTelemetry
{
    /// <summary>Of the `ActivitySource`. Its spans are of kind Client for requests of stubs, and Server for those of handlers.</summary>
    public const string ActivitySourceName = "Robdef.Runtime";

    /// <summary>
    /// Of the `Meter`. `rpc.client.call.duration` and `rpc.server.call.duration` are histograms in seconds; of a server from
    /// bringing the request to its handler to the answer. `robdef.server.sessions` is the number of clients of a service
    /// (tag `robdef.service`).
    /// </summary>
    public const string MeterName = "Robdef.Runtime";

    // Before what is made of it: static members are made in this order.
    private static readonly Meter s_meter = new(MeterName);

    internal static ActivitySource Source { get; } = new(ActivitySourceName);

    internal static Histogram<double> ClientDuration { get; } =
        s_meter.CreateHistogram<double>("rpc.client.call.duration", "s", "Duration of the requests that stubs make.");

    internal static Histogram<double> ServerDuration { get; } =
        s_meter.CreateHistogram<double>("rpc.server.call.duration", "s", "Duration of the requests that handlers answer.");

    internal static UpDownCounter<long> Sessions { get; } =
        s_meter.CreateUpDownCounter<long>("robdef.server.sessions", "{session}", "Clients that are connected to services.");
}
