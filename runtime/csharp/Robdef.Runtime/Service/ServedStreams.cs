// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading.Tasks;
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

    /// <summary>The endpoints that are connected now. Disposing of one disconnects it; letting it go does not.</summary>
    public unsafe PipeEndpoint<T>[] GetEndpoints()
    {
        KnownTypes types = _skeleton.RrTypes;
        return ServedEnds.Get(_skeleton.RrServed, _member, types, &Functions.rr_served_pipe_endpoints, &Functions.rr_pipe_release,
            end => new PipeEndpoint<T>(new PipeHandle(end), types, MessageVersion.V4, _codec));
    }

    /// <summary>In <see cref="Send"/>, endpoints with more packets that are not acknowledged are passed over; 0: none.</summary>
    public void SetBacklogLimit(int packets) => _skeleton.RrWithServed(_member | ServedEnds.Limits, served => SetLimit(served, packets));

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

    private unsafe void SetLimit(ServedHandle served, int packets)
    {
        nint error;
        Failure.Check(Functions.rr_served_pipe_set_backlog_limit(served, _member, (nuint)packets, &error), error, _skeleton.RrTypes);
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
    /// <param name="onPeekIn">What is told of the service's value; null: what was sent to all last.</param>
    /// <param name="onPeekOut">What is told of the clients' value; null: the newest of any of them.</param>
    public void SetHandler(Action<T, DateTimeOffset, uint>? onValue, Action<WireConnection<T>>? onConnect = null, Func<T>? onPeekIn = null,
        Func<T>? onPeekOut = null)
    {
        _skeleton.RrSetPeeks(_member, new WirePeeks<T>(_codec, onPeekIn, onPeekOut));
        _skeleton.RrWithServed(_member, served => Set(served, onValue, onConnect, onPeekIn is not null, onPeekOut is not null));
    }

    /// <summary>The ends of the clients that are connected now. Disposing of one disconnects it; letting it go does not.</summary>
    public unsafe WireConnection<T>[] GetConnections()
    {
        KnownTypes types = _skeleton.RrTypes;
        return ServedEnds.Get(_skeleton.RrServed, _member, types, &Functions.rr_served_wire_connections, &Functions.rr_wire_release,
            end => new WireConnection<T>(new WireHandle(end), types, MessageVersion.V4, _codec, isClient: false));
    }

    /// <summary>A received value older than this is as none; zero: never.</summary>
    public void SetLifespan(TimeSpan lifespan) => _skeleton.RrWithServed(_member | ServedEnds.Limits, served => SetLimit(served, lifespan));

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
        return WireValues.TryTake(status, error, data, time, _codec, _skeleton.RrTypes, out value);
    }

    private unsafe void SetLimit(ServedHandle served, TimeSpan lifespan)
    {
        nint error;
        int status = Functions.rr_served_wire_set_lifespan(served, _member, Times.Milliseconds(lifespan), &error);
        Failure.Check(status, error, _skeleton.RrTypes);
    }

    private unsafe void Set(ServedHandle served, Action<T, DateTimeOffset, uint>? onValue, Action<WireConnection<T>>? onConnect,
        bool handlesPeekIn, bool handlesPeekOut)
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
            HandlesPeekIn = handlesPeekIn ? 1u : 0,
            HandlesPeekOut = handlesPeekOut ? 1u : 0,
        };
        nint error;
        Failure.Check(Functions.rr_served_wire_set_handler(served, _member, &native, &error), error, types);
    }
}

/// <summary>Answers those who ask for a wire's value without a connection.</summary>
internal abstract class WirePeeks
{
    public abstract ValueTask Answer(ServedRequest request);
}

internal sealed class WirePeeks<T>(ValueCodec<T> codec, Func<T>? peekIn, Func<T>? peekOut) : WirePeeks
{
    public override ValueTask Answer(ServedRequest request)
    {
        Func<T> peek = (request.IsPeekIn ? peekIn : peekOut) ?? throw new ValueNotSetException("the wire has no value");
        return request.AnswerAsync(new ValueTask<T>(peek()), codec);
    }
}

/// <summary>The ends that clients have connected.</summary>
internal static unsafe class ServedEnds
{
    /// <summary>Tells limits of a member from its handlers.</summary>
    public const uint Limits = 0x80000000;

    public static TEnd[] Get<TEnd>(ServedHandle? served, uint member, KnownTypes types,
        delegate*<SafeHandle, uint, nint*, nuint*, nint*, int> ask, delegate*<nint, void> release, Func<nint, TEnd> make)
    {
        if (served is null)
        {
            return [];
        }
        nint error;
        nuint room = 0;
        while (true)
        {
            nint[] ends = new nint[room];
            nuint count = room;
            fixed (nint* first = ends)
            {
                Failure.Check(ask(served, member, first, &count, &error), error, types);
            }
            if (count <= room)
            {
                return Array.ConvertAll(ends[..(int)count], end => make(end));
            }
            // Handles of those that fitted were given, too.
            foreach (nint end in ends)
            {
                release(end);
            }
            room = count;
        }
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
