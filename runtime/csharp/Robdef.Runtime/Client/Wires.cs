// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>A value of a wire, and when it was sent.</summary>
/// <param name="Value">The value.</param>
/// <param name="Time">By the sender's clock.</param>
public readonly record struct WireValue<T>(T Value, DateTimeOffset Time);

/// <summary>A wire of an object on another node: of its values only the newest counts.</summary>
/// <typeparam name="T">The value.</typeparam>
public sealed class Wire<T>
{
    private readonly ObjectHandle _object;
    private readonly string _member;
    private readonly MemberAccess _access;
    private readonly ValueCodec<T> _codec;

    /// <summary>The wire of a stub.</summary>
    public Wire(Stub stub, string member, MemberAccess access, ValueCodec<T> codec)
    {
        ArgumentNullException.ThrowIfNull(stub);
        _object = stub.RrHandle;
        _member = member;
        _access = access;
        _codec = codec;
    }

    /// <summary>Connects, in the thread of the caller. InvalidOperation when this client has connected it already.</summary>
    public unsafe WireConnection<T> Connect()
    {
        using var name = new NativeText(_member);
        nint error;
        int status = Functions.rr_wire_connect(_object.Native, name.Value, (uint)_access, null, out nint wire, &error);
        Failure.Check(status, error, _object.Types);
        return new WireConnection<T>(new WireHandle(wire), _object.Types, _object.Version, _codec, isClient: true);
    }

    /// <summary>Connects. InvalidOperation when this client has connected it already.</summary>
    public unsafe Task<WireConnection<T>> ConnectAsync(CancellationToken cancel = default)
    {
        if (cancel.IsCancellationRequested)
        {
            return Task.FromCanceled<WireConnection<T>>(cancel);
        }
        KnownTypes types = _object.Types;
        MessageVersion version = _object.Version;
        var completion = new TaskCompletion<WireConnection<T>>(types, wire => new WireConnection<T>(new WireHandle(wire), types, version, _codec, isClient: true), cancel);
        using var name = new NativeText(_member);
        var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Cancellation = completion.Cancellation };
        RrCompletion native = completion.Native;
        nint error;
        int status = Functions.rr_wire_connect_async(_object.Native, name.Value, (uint)_access, &options, &native, &error);
        return status == 0 ? completion.Task : Task.FromException<WireConnection<T>>(completion.Abandon(native, status, error));
    }

    /// <summary>The service's value now, without a connection; asked in the thread of the caller.</summary>
    public WireValue<T> PeekInValue(CancellationToken cancel = default) => Peek(isIn: true, cancel);

    /// <summary>The value that the service has last received from a client.</summary>
    public WireValue<T> PeekOutValue(CancellationToken cancel = default) => Peek(isIn: false, cancel);

    /// <summary>The service's value now, without a connection.</summary>
    public Task<WireValue<T>> PeekInValueAsync(CancellationToken cancel = default) => PeekAsync(isIn: true, cancel);

    /// <summary>The value that the service has last received from a client.</summary>
    public Task<WireValue<T>> PeekOutValueAsync(CancellationToken cancel = default) => PeekAsync(isIn: false, cancel);

    /// <summary>Gives the service a value without a connection, in the thread of the caller.</summary>
    public unsafe void PokeOutValue(T value, CancellationToken cancel = default)
    {
        var cancellation = new NativeCancellation(cancel);
        ElementWriter writer = Writers.Rent(_object.Version);
        _codec.Write(writer, "value"u8, value);
        using var name = new NativeText(_member);
        fixed (byte* first = writer.Written)
        {
            cancellation.Begin();
            RrElements elements = Elements.Of(first, writer);
            var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Cancellation = cancellation.Handle };
            nint error;
            int status = Functions.rr_wire_poke_out(_object.Native, name.Value, &elements, &options, &error);
            cancellation.End();
            Writers.Return(writer);
            if (status != 0)
            {
                throw cancellation.Failed(Failure.Take(status, error, _object.Types));
            }
        }
    }

    /// <summary>Gives the service a value without a connection.</summary>
    public unsafe Task PokeOutValueAsync(T value, CancellationToken cancel = default)
    {
        if (cancel.IsCancellationRequested)
        {
            return Task.FromCanceled(cancel);
        }
        ElementWriter writer = Writers.Rent(_object.Version);
        _codec.Write(writer, "value"u8, value);
        var completion = new TaskCompletion<bool>(_object.Types, static _ => true, cancel);
        using var name = new NativeText(_member);
        fixed (byte* first = writer.Written)
        {
            RrElements elements = Elements.Of(first, writer);
            var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Cancellation = completion.Cancellation };
            RrCompletion native = completion.Native;
            nint error;
            int status = Functions.rr_wire_poke_out_async(_object.Native, name.Value, &elements, &options, &native, &error);
            Writers.Return(writer);
            return status == 0 ? completion.Task : Task.FromException(completion.Abandon(native, status, error));
        }
    }

    private unsafe WireValue<T> Peek(bool isIn, CancellationToken cancel)
    {
        var cancellation = new NativeCancellation(cancel);
        cancellation.Begin();
        using var name = new NativeText(_member);
        var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Cancellation = cancellation.Handle };
        RrTime time;
        nint error;
        nint data;
        int status = isIn
            ? Functions.rr_wire_peek_in(_object.Native, name.Value, &options, out data, &time, &error)
            : Functions.rr_wire_peek_out(_object.Native, name.Value, &options, out data, &time, &error);
        cancellation.End();
        return status == 0
            ? new WireValue<T>(Elements.Take(data, _codec, _object.Types.Registry), Times.ToDateTime(time))
            : throw cancellation.Failed(Failure.Take(status, error, _object.Types));
    }

    private unsafe Task<WireValue<T>> PeekAsync(bool isIn, CancellationToken cancel)
    {
        if (cancel.IsCancellationRequested)
        {
            return Task.FromCanceled<WireValue<T>>(cancel);
        }
        // The native side writes the time before it completes, so its place must not move.
        nint time = (nint)NativeMemory.AllocZeroed((nuint)sizeof(RrTime));
        TypeRegistry registry = _object.Types.Registry;
        var completion = new TaskCompletion<WireValue<T>>(_object.Types, data => new WireValue<T>(Elements.Take(data, _codec, registry), Times.ToDateTime(*(RrTime*)time)), cancel);
        using var name = new NativeText(_member);
        var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Cancellation = completion.Cancellation };
        RrCompletion native = completion.Native;
        nint error;
        int status = isIn
            ? Functions.rr_wire_peek_in_async(_object.Native, name.Value, &options, (RrTime*)time, &native, &error)
            : Functions.rr_wire_peek_out_async(_object.Native, name.Value, &options, (RrTime*)time, &native, &error);
        Task<WireValue<T>> task = status == 0
            ? completion.Task
            : Task.FromException<WireValue<T>>(completion.Abandon(native, status, error));
        task.ContinueWith(static (_, place) => NativeMemory.Free((void*)(nint)place!), time, CancellationToken.None,
            TaskContinuationOptions.ExecuteSynchronously, TaskScheduler.Default);
        return task;
    }
}

/// <summary>
/// One end of a connected wire. What a client receives is "in", and what it sends "out"; a service
/// sends "in" and receives "out".
/// </summary>
/// <typeparam name="T">The value.</typeparam>
public sealed class WireConnection<T> : IDisposable
{
    private readonly Lock _lock = new();
    private readonly WireHandle _handle;
    private readonly KnownTypes _types;
    private readonly MessageVersion _version;
    private readonly ValueCodec<T> _codec;
    private readonly bool _isClient;
    private Action<T, DateTimeOffset>? _changed;
    private Action? _closed;
    private bool _hasSink;

    internal WireConnection(WireHandle handle, KnownTypes types, MessageVersion version, ValueCodec<T> codec, bool isClient)
    {
        _handle = handle;
        _types = types;
        _version = version;
        _codec = codec;
        _isClient = isClient;
    }

    /// <summary>
    /// A new value has come, and when it was sent. One at a time, in order; a slow handler misses values, never
    /// the newest.
    /// </summary>
    public event Action<T, DateTimeOffset> ValueChanged
    {
        add => Listen(() => _changed += value);
        remove
        {
            lock (_lock)
            {
                _changed -= value;
            }
        }
    }

    /// <summary>The end was closed, by whomever.</summary>
    public event Action Closed
    {
        add => Listen(() => _closed += value);
        remove
        {
            lock (_lock)
            {
                _closed -= value;
            }
        }
    }

    /// <summary>The newest value that has come: of the service on the client's side. ValueNotSet for none.</summary>
    public T InValue => _isClient ? Received().Value : Sent().Value;

    /// <summary>What goes to the service; on the service's side what has come from the client.</summary>
    public T OutValue
    {
        get => _isClient ? Sent().Value : Received().Value;
        set => Send(value);
    }

    /// <summary>Whether both sides have it.</summary>
    public bool IsOpen => Functions.rr_wire_is_open(_handle) != 0;

    /// <summary>On the service's side: the client. 0 on the client's side.</summary>
    public uint Client => Functions.rr_wire_client(_handle);

    /// <summary>The newest value that has come; false for none.</summary>
    public bool TryGetReceived(out WireValue<T> value) => TryRead(isReceived: true, out value);

    /// <summary>Sends a value to the other side. Never waits.</summary>
    public unsafe void Send(T value)
    {
        ElementWriter writer = Writers.Rent(_version);
        _codec.Write(writer, "packet"u8, value);
        fixed (byte* first = writer.Written)
        {
            RrElements elements = Elements.Of(first, writer);
            nint error;
            int status = Functions.rr_wire_send(_handle, &elements, &error);
            Writers.Return(writer);
            Failure.Check(status, error, _types);
        }
    }

    /// <summary>Waits until a value has come; false when the time was over, or the end closed, before.</summary>
    public bool WaitReceived(TimeSpan limit) => Functions.rr_wire_wait(_handle, Times.Milliseconds(limit)) != 0;

    /// <summary>A received value older than this is as none; zero: never.</summary>
    public void SetLifespan(TimeSpan lifespan) => Functions.rr_wire_set_lifespan(_handle, Times.Milliseconds(lifespan));

    /// <summary>Disconnects.</summary>
    public void Close() => Functions.rr_wire_close(_handle);

    /// <summary>Disconnects, and lets go of the end.</summary>
    public void Dispose()
    {
        if (!_handle.IsClosed)
        {
            Close();
            _handle.Dispose();
        }
    }

    internal void Tell(T value, DateTimeOffset time) => _changed?.Invoke(value, time);

    internal void TellClosed() => _closed?.Invoke();

    private WireValue<T> Received() => TryRead(isReceived: true, out WireValue<T> value) ? value : throw NotSet();

    private WireValue<T> Sent() => TryRead(isReceived: false, out WireValue<T> value) ? value : throw NotSet();

    private static RobdefException NotSet() => new(ErrorCode.ValueNotSet, "the wire has no value");

    private unsafe bool TryRead(bool isReceived, out WireValue<T> value)
    {
        RrTime time;
        nint error;
        nint data;
        int status = isReceived
            ? Functions.rr_wire_received(_handle, out data, &time, &error)
            : Functions.rr_wire_sent(_handle, out data, &time, &error);
        if (status == (int)ErrorCode.ValueNotSet)
        {
            _ = Failure.Take(status, error, _types);
            value = default;
            return false;
        }
        Failure.Check(status, error, _types);
        value = new WireValue<T>(Elements.Take(data, _codec, _types.Registry), Times.ToDateTime(time));
        return true;
    }

    /// <summary>The native handler is set with the first listener, so that ends without one cost nothing.</summary>
    private unsafe void Listen(Action add)
    {
        lock (_lock)
        {
            add();
            if (_hasSink)
            {
                return;
            }
            _hasSink = true;
        }
        var native = new RrWireHandler
        {
            Size = (nuint)sizeof(RrWireHandler),
            Context = Context.Of(new WireSink<T>(this, _types, _codec)),
            OnValue = &WireSink.OnValue,
            OnClosed = &WireSink.OnClosed,
            Drop = &Context.Drop,
        };
        nint error;
        Failure.Check(Functions.rr_wire_set_handler(_handle, &native, &error), error, _types);
    }
}

/// <summary>Where the native runtime brings the values of one end of a wire.</summary>
internal abstract unsafe class WireSink
{
    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnValue(nint context, RrElements* value, RrTime* time, nint data)
    {
        try
        {
            Context.Get<WireSink>(context).Receive(*value, Times.ToDateTime(*time));
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnClosed(nint context)
    {
        try
        {
            Context.Get<WireSink>(context).Close();
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }

    protected abstract void Receive(in RrElements value, DateTimeOffset time);

    protected abstract void Close();
}

internal sealed class WireSink<T>(WireConnection<T> connection, KnownTypes types, ValueCodec<T> codec) : WireSink
{
    protected override void Receive(in RrElements value, DateTimeOffset time) =>
        connection.Tell(codec.Read(Elements.Reader(value, types.Registry).Read()), time);

    protected override void Close() => connection.TellClosed();
}
