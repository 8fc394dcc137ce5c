// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>A pipe that an object offers.</summary>
/// <typeparam name="T">The packet.</typeparam>
public sealed class PipeServer<T>
{
    private readonly Skeleton _skeleton;
    private readonly uint _member;
    private readonly ValueCodec<T> _codec;

    /// <summary>The pipe of a skeleton.</summary>
    public PipeServer(Skeleton skeleton, uint member, ValueCodec<T> codec)
    {
        _skeleton = skeleton;
        _member = member;
        _codec = codec;
    }

    /// <summary>Says what to do with each endpoint that a client connects, before the client has its answer.</summary>
    public void SetConnectHandler(Action<PipeEndpoint<T>> onConnect)
    {
        ArgumentNullException.ThrowIfNull(onConnect);
        _skeleton.RrWithServed(_member, served => Set(served, onConnect));
    }

    /// <summary>Sends a packet to all endpoints of all clients; without a service to nobody.</summary>
    public unsafe void Send(T packet)
    {
        if (_skeleton.RrServed is not { } served)
        {
            return;
        }
        ElementWriter writer = Writers.Rent(MessageVersion.V4);
        _codec.Write(writer, "packet"u8, packet);
        fixed (byte* first = writer.Written)
        {
            RrElements elements = Elements.Of(first, writer);
            nint error;
            int status = Functions.rr_served_pipe_send(served, _member, &elements, &error);
            Writers.Return(writer);
            Failure.Check(status, error, _skeleton.RrTypes);
        }
    }

    private unsafe void Set(ServedHandle served, Action<PipeEndpoint<T>> onConnect)
    {
        KnownTypes types = _skeleton.RrTypes;
        var native = new RrServedPipeHandler
        {
            Size = (nuint)sizeof(RrServedPipeHandler),
            Context = Context.Of(new ConnectSink(pipe =>
                onConnect(new PipeEndpoint<T>(new PipeHandle(pipe), types, MessageVersion.V4, _codec)))),
            OnConnect = &ConnectSink.OnConnect,
            Drop = &Context.Drop,
        };
        nint error;
        Failure.Check(Functions.rr_served_pipe_set_handler(served, _member, &native, &error), error, types);
    }
}

/// <summary>A wire that an object offers.</summary>
/// <typeparam name="T">The value.</typeparam>
public sealed class WireServer<T>
{
    private readonly Skeleton _skeleton;
    private readonly uint _member;
    private readonly ValueCodec<T> _codec;

    /// <summary>The wire of a skeleton.</summary>
    public WireServer(Skeleton skeleton, uint member, ValueCodec<T> codec)
    {
        _skeleton = skeleton;
        _member = member;
        _codec = codec;
    }

    /// <summary>Says what to do with values that clients send or poke, and with each that connects. Once, before clients connect.</summary>
    /// <param name="onValue">The value, when it was sent, and by which client; one at a time for each client.</param>
    /// <param name="onConnect">The end that belongs to the client.</param>
    public void SetHandler(Action<T, DateTimeOffset, uint>? onValue, Action<WireConnection<T>>? onConnect = null) =>
        _skeleton.RrWithServed(_member, served => Set(served, onValue, onConnect));

    /// <summary>Sends a value to all connected clients, and to each that connects later; without a service to nobody.</summary>
    public unsafe void Send(T value)
    {
        if (_skeleton.RrServed is not { } served)
        {
            return;
        }
        ElementWriter writer = Writers.Rent(MessageVersion.V4);
        _codec.Write(writer, "packet"u8, value);
        fixed (byte* first = writer.Written)
        {
            RrElements elements = Elements.Of(first, writer);
            nint error;
            int status = Functions.rr_served_wire_send(served, _member, &elements, &error);
            Writers.Return(writer);
            Failure.Check(status, error, _skeleton.RrTypes);
        }
    }

    /// <summary>The newest value from any client; false for none.</summary>
    public unsafe bool TryGetReceived(out WireValue<T> value)
    {
        value = default;
        if (_skeleton.RrServed is not { } served)
        {
            return false;
        }
        RrTime time;
        nint error;
        int status = Functions.rr_served_wire_received(served, _member, out nint data, &time, &error);
        if (status == (int)ErrorCode.ValueNotSet)
        {
            _ = Failure.Take(status, error, _skeleton.RrTypes);
            return false;
        }
        Failure.Check(status, error, _skeleton.RrTypes);
        value = new WireValue<T>(Elements.Take(data, _codec, _skeleton.RrTypes.Registry), Times.ToDateTime(time));
        return true;
    }

    private unsafe void Set(ServedHandle served, Action<T, DateTimeOffset, uint>? onValue, Action<WireConnection<T>>? onConnect)
    {
        KnownTypes types = _skeleton.RrTypes;
        var sink = new ConnectSink(
            wire => onConnect?.Invoke(new WireConnection<T>(new WireHandle(wire), types, MessageVersion.V4, _codec, isClient: false)),
            (client, elements, time) => onValue?.Invoke(_codec.Read(Elements.Reader(elements, types.Registry).Read()), time, client));
        var native = new RrServedWireHandler
        {
            Size = (nuint)sizeof(RrServedWireHandler),
            Context = Context.Of(sink),
            OnConnect = onConnect is null ? null : &ConnectSink.OnConnect,
            OnValue = onValue is null ? null : &ConnectSink.OnValue,
            Drop = &Context.Drop,
        };
        nint error;
        Failure.Check(Functions.rr_served_wire_set_handler(served, _member, &native, &error), error, types);
    }
}

/// <summary>Where the native runtime brings what clients do with a stream of an object.</summary>
internal sealed unsafe class ConnectSink(Action<nint> connect, Action<uint, RrElements, DateTimeOffset>? receive = null)
{
    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnConnect(nint context, nint end)
    {
        try
        {
            Context.Get<ConnectSink>(context).Connect(end);
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnValue(nint context, uint client, RrElements* value, RrTime* time, nint data)
    {
        try
        {
            Context.Get<ConnectSink>(context).Receive(client, *value, Times.ToDateTime(*time));
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }

    private void Connect(nint end) => connect(end);

    private void Receive(uint client, RrElements value, DateTimeOffset time) => receive?.Invoke(client, value, time);
}
