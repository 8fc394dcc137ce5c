// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>Where the native runtime brings the events of one subscription. Keeps the stub that subscribed.</summary>
internal abstract unsafe class EventSink
{
    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnEvent(nint context, RrElements* arguments, nint data)
    {
        try
        {
            Context.Get<EventSink>(context).Receive(*arguments);
        }
        catch (Exception exception)
        {
            // Nobody waits for it, and it must not go on into native code.
            Unhandled.Report(exception);
        }
    }

    protected abstract void Receive(in RrElements arguments);
}

internal sealed class EventSink<THandler>(Stub stub, THandler handler, EventReader<THandler> read) : EventSink
{
    protected override void Receive(in RrElements arguments)
    {
        FieldReader fields = Elements.Fields(arguments, stub.RrHandle.Types.Registry);
        read(handler, ref fields);
    }
}

/// <summary>Where the native runtime brings the calls of one callback.</summary>
internal abstract unsafe class CallbackSink(Session session, string member)
{
    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnCall(nint context, nint request)
    {
        var info = new RrRequestInfo { Size = (nuint)sizeof(RrRequestInfo) };
        Functions.rr_request_read(request, &info);
        CallbackSink sink = Context.Get<CallbackSink>(context);
        ServedRequest asked = sink.Request(request, info);
        try
        {
            sink.Answer(asked);
        }
        catch (Exception exception)
        {
            asked.Fail(exception);
        }
    }

    protected abstract void Answer(ServedRequest request);

    private ServedRequest Request(nint request, in RrRequestInfo info) =>
        new(request, info, session.Types, session.Node.Callbacks, member, null);
}

internal sealed class CallbackSink<TFunction, TResult>(Session session, string member, TFunction function,
    CallbackReader<TFunction, Task<TResult>> read, ValueCodec<TResult> codec) : CallbackSink(session, member)
{
    protected override void Answer(ServedRequest request)
    {
        FieldReader fields = request.Arguments;
        _ = request.AnswerAsync(new ValueTask<TResult>(read(function, ref fields)), codec).AsTask();
    }
}

internal sealed class VoidCallbackSink<TFunction>(Session session, string member, TFunction function,
    CallbackReader<TFunction, Task> read) : CallbackSink(session, member)
{
    protected override void Answer(ServedRequest request)
    {
        FieldReader fields = request.Arguments;
        _ = request.AnswerAsync(new ValueTask(read(function, ref fields))).AsTask();
    }
}

/// <summary>What handlers throw where nobody waits.</summary>
public static class Unhandled
{
    /// <summary>Told of each exception that a handler of an event, packet or value has thrown, on the thread where that was.</summary>
    public static event Action<Exception>? Thrown;

    internal static void Report(Exception exception)
    {
        try
        {
            Thrown?.Invoke(exception);
        }
        catch (Exception)
        {
            // The last resort has failed as well.
        }
    }
}

/// <summary>Times as the native runtime counts them.</summary>
internal static class Times
{
    public static int Milliseconds(TimeSpan time) => time == System.Threading.Timeout.InfiniteTimeSpan
        ? -1
        : (int)Math.Clamp(Math.Ceiling(time.TotalMilliseconds), 0, int.MaxValue);

    public static DateTimeOffset ToDateTime(in RrTime time) =>
        DateTimeOffset.FromUnixTimeSeconds(Math.Clamp(time.Seconds, -62135596800, 253402300799)).AddTicks(time.Nanoseconds / 100);
}
