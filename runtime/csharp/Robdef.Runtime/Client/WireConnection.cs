// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

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

    /// <summary>The next value that comes, and when it was sent.</summary>
    /// <param name="cancel">Ends the waiting.</param>
    /// <exception cref="RobdefInvalidOperationException">The end is closed before one comes.</exception>
    public async Task<WireValue<T>> ReceiveAsync(CancellationToken cancel = default)
    {
        cancel.ThrowIfCancellationRequested();
        var next = new TaskCompletionSource<WireValue<T>>(TaskCreationOptions.RunContinuationsAsynchronously);
        void Take(T value, DateTimeOffset time) => next.TrySetResult(new WireValue<T>(value, time));
        void End() => next.TrySetException(new RobdefInvalidOperationException("the wire connection is closed"));
        ValueChanged += Take;
        Closed += End;
        try
        {
            if (!IsOpen)
            {
                End();
            }
            return await next.Task.WaitAsync(cancel).ConfigureAwait(false);
        }
        finally
        {
            ValueChanged -= Take;
            Closed -= End;
        }
    }

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

    private static ValueNotSetException NotSet() => new ValueNotSetException("the wire has no value");

    private unsafe bool TryRead(bool isReceived, out WireValue<T> value)
    {
        RrTime time;
        nint error;
        nint data;
        int status = isReceived
            ? Functions.rr_wire_received(_handle, out data, &time, &error)
            : Functions.rr_wire_sent(_handle, out data, &time, &error);
        return WireValues.TryTake(status, error, data, time, _codec, _types, out value);
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
