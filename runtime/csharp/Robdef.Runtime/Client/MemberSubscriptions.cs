// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>A value of a wire, when it was sent, and by which client's service.</summary>
/// <param name="Value">The value.</param>
/// <param name="Time">By the sender's clock.</param>
/// <param name="Client">The client to whose service the wire belongs.</param>
public readonly record struct ClientValue<T>(T Value, DateTimeOffset Time, SubscribedClientId Client);

/// <summary>
/// A member of all clients of a subscription; until it is disposed of or the subscription is. Connected when a client
/// comes, and again when the service comes back.
/// </summary>
/// <typeparam name="T">The value or packet.</typeparam>
public abstract unsafe class MemberSubscription<T> : IDisposable
{
    private readonly delegate*<SafeHandle, void> _close;
    private readonly delegate*<SafeHandle, RrElements*, nuint*, nint*, int> _send;
    private readonly delegate*<SafeHandle, RrSubscriptionHandler*, nint*, int> _setHandler;
    private readonly delegate*<SafeHandle, nint, delegate* unmanaged[Cdecl]<nint, RrSubscribedClient*, void>, nint*, int> _clients;

    private protected MemberSubscription(SafeHandle handle, ValueCodec<T> codec, KnownTypes types, delegate*<SafeHandle, void> close,
        delegate*<SafeHandle, RrElements*, nuint*, nint*, int> send, delegate*<SafeHandle, RrSubscriptionHandler*, nint*, int> setHandler,
        delegate*<SafeHandle, nint, delegate* unmanaged[Cdecl]<nint, RrSubscribedClient*, void>, nint*, int> clients)
    {
        Handle = handle;
        Codec = codec;
        Types = types;
        _close = close;
        _send = send;
        _setHandler = setHandler;
        _clients = clients;
    }

    /// <summary>The clients at which it is connected.</summary>
    public IReadOnlyList<SubscribedClientId> Clients => Each.Clients(Handle, _clients);

    private protected SafeHandle Handle { get; }

    private protected ValueCodec<T> Codec { get; }

    private protected KnownTypes Types { get; }

    /// <summary>Sends to all clients that are connected now.</summary>
    /// <returns>To how many.</returns>
    public int Send(T value)
    {
        ElementWriter writer = Writers.Rent(MessageVersion.V4);
        Codec.Write(writer, "packet"u8, value);
        fixed (byte* first = writer.Written)
        {
            RrElements elements = Elements.Of(first, writer);
            nuint count;
            nint error;
            int status = _send(Handle, &elements, &count, &error);
            Writers.Return(writer);
            Failure.Check(status, error, Types);
            return (int)count;
        }
    }

    /// <summary>Disconnects.</summary>
    public void Dispose()
    {
        if (!Handle.IsClosed)
        {
            _close(Handle);
            Handle.Dispose();
        }
        GC.SuppressFinalize(this);
    }

    /// <summary>Null for nothing; the sink is told what <paramref name="onReceived"/> is called with.</summary>
    private protected void SetSink(object? sink, void* onReceived)
    {
        nint error;
        if (sink is null)
        {
            Failure.Check(_setHandler(Handle, null, &error), error, Types);
            return;
        }
        var native = new RrSubscriptionHandler
        {
            Size = (nuint)sizeof(RrSubscriptionHandler),
            Context = Context.Of(sink),
            OnReceived = onReceived,
            Drop = &Context.Drop,
        };
        Failure.Check(_setHandler(Handle, &native, &error), error, Types);
    }

    private protected T Read(RrElements elements) => Codec.Read(Elements.Reader(elements, Types.Registry).Read());
}

/// <summary>A wire of all clients of a subscription.</summary>
/// <typeparam name="T">The value.</typeparam>
public sealed unsafe class WireSubscription<T> : MemberSubscription<T>
{
    internal WireSubscription(ServiceSubscriptionHandle subscription, string member, string path, ValueCodec<T> codec, KnownTypes types)
        : base(Subscribe(subscription, member, path, types), codec, types, &Functions.rr_wire_subscription_close,
            &Functions.rr_wire_subscription_send, &Functions.rr_wire_subscription_set_handler, &Functions.rr_wire_subscription_clients)
    {
    }

    /// <summary>The value that has come last, from whichever client; false for none.</summary>
    public bool TryGetReceived(out WireValue<T> value)
    {
        RrTime time;
        nint error;
        int status = Functions.rr_wire_subscription_received(Handle, out nint data, &time, &error);
        return WireValues.TryTake(status, error, data, time, Codec, Types, out value);
    }

    /// <summary>The same, and the client that it came from.</summary>
    public bool TryGetReceived(out WireValue<T> value, out SubscribedClientId client)
    {
        ClientValue<T> newest = default;
        int status = Each.Values(Handle, &Functions.rr_wire_subscription_newest, (from, elements, time) => newest = Value(from, elements, time),
            out nint error);
        value = new WireValue<T>(newest.Value, newest.Time);
        client = newest.Client;
        if (status == (int)ErrorCode.ValueNotSet)
        {
            Functions.rr_error_release(error);
            return false;
        }
        Failure.Check(status, error, Types);
        return true;
    }

    /// <summary>The newest value of each connected client that has one.</summary>
    public IReadOnlyList<ClientValue<T>> GetAllReceived()
    {
        var values = new List<ClientValue<T>>();
        int status = Each.Values(Handle, &Functions.rr_wire_subscription_values,
            (client, elements, time) => values.Add(Value(client, elements, time)), out nint error);
        Failure.Check(status, error, Types);
        return values;
    }

    /// <summary>A value that came longer ago is as none; zero: values never expire, not even when their client goes.</summary>
    public void SetLifespan(TimeSpan lifespan)
    {
        nint error;
        Failure.Check(Functions.rr_wire_subscription_set_lifespan(Handle, Times.Milliseconds(lifespan), &error), error, Types);
    }

    /// <summary>Waits until a value has come; false when the time was over before.</summary>
    public bool WaitReceived(TimeSpan limit) => Functions.rr_wire_subscription_wait(Handle, Times.Milliseconds(limit)) != 0;

    /// <summary>
    /// Calls this with each value and the time when it was sent, one at a time, on a thread of the node; null: nothing. A
    /// slow function misses values, never the newest.
    /// </summary>
    public void SetHandler(Action<T, DateTimeOffset>? onValue) =>
        SetReceiver(onValue is null ? null : (_, elements, time) => onValue(Read(elements), time));

    /// <summary>The same, and the client that each value came from. The newest function of either kind counts.</summary>
    public void SetClientHandler(Action<T, DateTimeOffset, SubscribedClientId>? onValue) =>
        SetReceiver(onValue is null ? null : (client, elements, time) => onValue(Read(elements), time, SubscribedClientId.Of(client)));

    private void SetReceiver(TakeElements? receive)
    {
        delegate* unmanaged[Cdecl]<nint, RrSubscribedClient*, RrElements*, RrTime*, nint, void> received = &SubscriptionReceived.OnValue;
        SetSink(receive, received);
    }

    private ClientValue<T> Value(RrSubscribedClient* client, RrElements elements, DateTimeOffset time) =>
        new(Read(elements), time, SubscribedClientId.Of(client));

    private static WireSubscriptionHandle Subscribe(ServiceSubscriptionHandle subscription, string member, string path, KnownTypes types)
    {
        using var name = new NativeText(member);
        using var place = new NativeText(path);
        nint error;
        Failure.Check(Functions.rr_wire_subscribe(subscription, name.Value, place.Value, out nint wire, &error), error, types);
        return new WireSubscriptionHandle(wire);
    }
}

/// <summary>A pipe of all clients of a subscription: one endpoint at each, whose packets come together here.</summary>
/// <typeparam name="T">The packet.</typeparam>
public sealed unsafe class PipeSubscription<T> : MemberSubscription<T>
{
    internal PipeSubscription(ServiceSubscriptionHandle subscription, string member, string path, ValueCodec<T> codec, int maxReceived,
        KnownTypes types)
        : base(Subscribe(subscription, member, path, maxReceived, types), codec, types, &Functions.rr_pipe_subscription_close,
            &Functions.rr_pipe_subscription_send, &Functions.rr_pipe_subscription_set_handler, &Functions.rr_pipe_subscription_clients)
    {
    }

    /// <summary>The packet that has waited longest; false for none.</summary>
    public bool TryReceive(out T packet)
    {
        nint error;
        Failure.Check(Functions.rr_pipe_subscription_receive(Handle, out nint data, &error), error, Types);
        packet = data == 0 ? default! : Elements.Take(data, Codec, Types.Registry);
        return data != 0;
    }

    /// <summary>The same, and the client that it came from.</summary>
    public bool TryReceive(out T packet, out SubscribedClientId client)
    {
        T received = default!;
        SubscribedClientId? sender = null;
        Each.Packet(Handle, (from, elements, _) =>
        {
            sender = SubscribedClientId.Of(from);
            received = Read(elements);
        }, Types);
        packet = received;
        client = sender ?? default;
        return sender is not null;
    }

    /// <summary>Waits for a packet; false when the time was over before.</summary>
    public bool TryReceive(TimeSpan limit, out T packet)
    {
        if (Functions.rr_pipe_subscription_wait(Handle, Times.Milliseconds(limit)) == 0)
        {
            packet = default!;
            return false;
        }
        return TryReceive(out packet);
    }

    /// <summary>The same, and the client that it came from.</summary>
    public bool TryReceive(TimeSpan limit, out T packet, out SubscribedClientId client)
    {
        if (Functions.rr_pipe_subscription_wait(Handle, Times.Milliseconds(limit)) == 0)
        {
            packet = default!;
            client = default;
            return false;
        }
        return TryReceive(out packet, out client);
    }

    /// <summary>
    /// Calls this with the packets that wait and those that come, in order, one at a time, on a thread of the node, instead
    /// of keeping them; null: they are kept.
    /// </summary>
    public void SetHandler(Action<T>? onPacket) => SetReceiver(onPacket is null ? null : (_, elements, _) => onPacket(Read(elements)));

    /// <summary>The same, and the client that each packet came from. The newest function of either kind counts.</summary>
    public void SetClientHandler(Action<T, SubscribedClientId>? onPacket) =>
        SetReceiver(onPacket is null ? null : (client, elements, _) => onPacket(Read(elements), SubscribedClientId.Of(client)));

    private void SetReceiver(TakeElements? receive)
    {
        delegate* unmanaged[Cdecl]<nint, RrSubscribedClient*, RrElements*, nint, void> received = &SubscriptionReceived.OnPacket;
        SetSink(receive, received);
    }

    private static PipeSubscriptionHandle Subscribe(ServiceSubscriptionHandle subscription, string member, string path, int maxReceived,
        KnownTypes types)
    {
        ArgumentOutOfRangeException.ThrowIfNegative(maxReceived);
        using var name = new NativeText(member);
        using var place = new NativeText(path);
        nint error;
        int status = Functions.rr_pipe_subscribe(subscription, name.Value, place.Value, (nuint)maxReceived, out nint pipe, &error);
        Failure.Check(status, error, types);
        return new PipeSubscriptionHandle(pipe);
    }
}

/// <summary>An object of the client that has been connected longest.</summary>
/// <typeparam name="TObject">The stub of the object.</typeparam>
public sealed unsafe class ObjectSubscription<TObject> : IDisposable
    where TObject : Stub, IStub<TObject>
{
    private readonly ObjectSubscriptionHandle _handle;
    private readonly Node _node;
    private readonly KnownTypes _types;

    internal ObjectSubscription(ServiceSubscriptionHandle subscription, Node node, string path, KnownTypes types)
    {
        _node = node;
        _types = types;
        using var place = new NativeText(path);
        nint error;
        Failure.Check(Functions.rr_object_subscribe(subscription, place.Value, out nint found, &error), error, types);
        _handle = new ObjectSubscriptionHandle(found);
    }

    /// <summary>The object of the client that is connected. It belongs to one connection: when that is lost its calls fail.</summary>
    /// <param name="limit">How long to wait for it; zero does not wait, and ConnectionError says why there is none.</param>
    /// <exception cref="RobdefException">OperationTimeout when it was not found in time.</exception>
    public TObject Get(TimeSpan limit = default)
    {
        nint error;
        int status = Functions.rr_object_subscription_get(_handle, Times.Milliseconds(limit), out nint found, &error);
        Failure.Check(status, error, _types);
        return TObject.RrCreate(new Session(_node, _types).Handle(found));
    }

    /// <summary>Looks for it no more.</summary>
    public void Dispose()
    {
        if (!_handle.IsClosed)
        {
            Functions.rr_object_subscription_close(_handle);
            _handle.Dispose();
        }
    }
}

/// <summary>Where the native runtime brings what comes through a member of a subscription. The context is a TakeElements.</summary>
internal static unsafe class SubscriptionReceived
{
    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnValue(nint context, RrSubscribedClient* client, RrElements* value, RrTime* time, nint data) =>
        Receive(context, client, *value, Times.ToDateTime(*time));

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnPacket(nint context, RrSubscribedClient* client, RrElements* packet, nint data) =>
        Receive(context, client, *packet, default);

    private static void Receive(nint context, RrSubscribedClient* client, RrElements elements, DateTimeOffset time)
    {
        try
        {
            Context.Get<TakeElements>(context)(client, elements, time);
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }
}
