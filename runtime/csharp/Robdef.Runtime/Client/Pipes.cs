// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>A pipe of an object on another node.</summary>
/// <typeparam name="T">The packet.</typeparam>
public sealed class Pipe<T>
{
    private readonly ObjectHandle _object;
    private readonly string _member;
    private readonly MemberAccess _access;
    private readonly ValueCodec<T> _codec;

    /// <summary>The pipe of a stub.</summary>
    public Pipe(Stub stub, string member, MemberAccess access, ValueCodec<T> codec)
    {
        ArgumentNullException.ThrowIfNull(stub);
        _object = stub.RrHandle;
        _member = member;
        _access = access;
        _codec = codec;
    }

    /// <summary>Connects an endpoint, in the thread of the caller.</summary>
    /// <param name="index">Wanted; the service decides. -1 leaves it to it.</param>
    /// <param name="isReliable">No packet may be lost or come in another order, although the definition lets them.</param>
    public unsafe PipeEndpoint<T> Connect(int index = -1, bool isReliable = false)
    {
        using RemoteUse target = _object.Use();
        using var name = new NativeText(_member);
        RrPipeOptions pipe = Options(index, isReliable);
        nint error;
        int status = Functions.rr_pipe_connect(target.Native, name.Value, &pipe, null, out nint end, &error);
        Failure.Check(status, error, _object.Types);
        return new PipeEndpoint<T>(new PipeHandle(end), _object.Types, _object.Version, _codec);
    }

    /// <summary>Connects an endpoint.</summary>
    /// <param name="index">Wanted; the service decides. -1 leaves it to it.</param>
    /// <param name="isReliable">No packet may be lost or come in another order, although the definition lets them.</param>
    /// <param name="cancel">Ends the waiting.</param>
    public unsafe Task<PipeEndpoint<T>> ConnectAsync(int index = -1, bool isReliable = false, CancellationToken cancel = default)
    {
        if (_object.Refusal<PipeEndpoint<T>>(cancel) is { } refused)
        {
            return refused;
        }
        using RemoteUse target = _object.Use();
        KnownTypes types = _object.Types;
        MessageVersion version = _object.Version;
        var completion = new TaskCompletion<PipeEndpoint<T>>(types, end => new PipeEndpoint<T>(new PipeHandle(end), types, version, _codec), cancel);
        using var name = new NativeText(_member);
        RrPipeOptions pipe = Options(index, isReliable);
        var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Cancellation = completion.Cancellation };
        RrCompletion native = completion.Native;
        nint error;
        int status = Functions.rr_pipe_connect_async(target.Native, name.Value, &pipe, &options, &native, &error);
        return status == 0 ? completion.Task : Task.FromException<PipeEndpoint<T>>(completion.Abandon(native, status, error));
    }

    private unsafe RrPipeOptions Options(int index, bool isReliable) =>
        new() { Size = (nuint)sizeof(RrPipeOptions), Access = (uint)_access, Index = index, Reliable = isReliable ? 1u : 0 };
}

/// <summary>
/// One end of a connected pipe, of a client or a service. It stays connected until it is closed, its session
/// ends or its object is released; packets that have come can be received from a closed end too.
/// </summary>
/// <typeparam name="T">The packet.</typeparam>
public sealed class PipeEndpoint<T> : IAsyncEnumerable<T>, IDisposable
{
    private readonly PipeHandle _handle;
    private readonly KnownTypes _types;
    private readonly MessageVersion _version;
    private readonly ValueCodec<T> _codec;

    internal PipeEndpoint(PipeHandle handle, KnownTypes types, MessageVersion version, ValueCodec<T> codec)
    {
        _handle = handle;
        _types = types;
        _version = version;
        _codec = codec;
    }

    /// <summary>Which of the pipe's endpoints.</summary>
    public int Index => Functions.rr_pipe_index(_handle);

    /// <summary>Whether both sides have it.</summary>
    public bool IsOpen => Functions.rr_pipe_is_open(_handle) != 0;

    /// <summary>Both sides have agreed that packets may be lost or come in another order.</summary>
    public bool IsUnreliable => Functions.rr_pipe_is_unreliable(_handle) != 0;

    /// <summary>On the service's side: the client. 0 on the client's side.</summary>
    public uint Client => Functions.rr_pipe_client(_handle);

    /// <summary>Whether packets that are sent from now on are acknowledged. Off at first.</summary>
    public void AskForAcknowledgements(bool on) => Functions.rr_pipe_ask_for_acknowledgements(_handle, on ? 1 : 0);

    /// <summary>How many sent packets the other side has not acknowledged yet, of those that are acknowledged.</summary>
    public int Unacknowledged => (int)Functions.rr_pipe_unacknowledged(_handle);

    /// <summary>How many packets can be received now.</summary>
    public int Available => (int)Functions.rr_pipe_available(_handle);

    /// <summary>Sends a packet. Never waits.</summary>
    /// <returns>Its number: 1, 2, ...</returns>
    /// <exception cref="RobdefException">BufferLimitViolation when the connection takes no more.</exception>
    public unsafe uint Send(T packet)
    {
        ElementWriter writer = Writers.Rent(_version);
        _codec.Write(writer, "packet"u8, packet);
        fixed (byte* first = writer.Written)
        {
            RrElements elements = Elements.Of(first, writer);
            uint number;
            nint error;
            int status = Functions.rr_pipe_send(_handle, &elements, &number, &error);
            Writers.Return(writer);
            Failure.Check(status, error, _types);
            return number;
        }
    }

    /// <summary>The packet that has waited longest; false for none.</summary>
    public unsafe bool TryReceive(out T packet)
    {
        nint error;
        Failure.Check(Functions.rr_pipe_receive(_handle, out nint data, &error), error, _types);
        packet = data == 0 ? default! : Elements.Take(data, _codec, _types.Registry);
        return data != 0;
    }

    /// <summary>Waits for a packet; false when the time was over, or the end closed, before.</summary>
    public bool TryReceive(TimeSpan limit, out T packet)
    {
        if (Functions.rr_pipe_wait(_handle, Times.Milliseconds(limit)) == 0)
        {
            packet = default!;
            return false;
        }
        return TryReceive(out packet);
    }

    /// <summary>The next packet.</summary>
    /// <param name="cancel">Ends the waiting; the packet that comes then is the next one's.</param>
    /// <exception cref="RobdefInvalidOperationException">The end is closed before one comes.</exception>
    public unsafe Task<T> ReceiveAsync(CancellationToken cancel = default)
    {
        if (cancel.IsCancellationRequested)
        {
            return Task.FromCanceled<T>(cancel);
        }
        var completion = new AnswerCompletion<T>(_types, _codec, cancel);
        RrCompletion native = completion.Native;
        var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Cancellation = completion.Cancellation };
        nint error;
        int status = Functions.rr_pipe_receive_within_async(_handle, &options, &native, &error);
        return status == 0 ? completion.Task : Task.FromException<T>(completion.Abandon(native, status, error));
    }

    /// <summary>All packets until the end is closed. Cancelled it takes no more, and loses none.</summary>
    public async IAsyncEnumerator<T> GetAsyncEnumerator(CancellationToken cancellationToken = default)
    {
        while (true)
        {
            T packet;
            try
            {
                packet = await ReceiveAsync(cancellationToken).ConfigureAwait(false);
            }
            catch (RobdefInvalidOperationException) when (!IsOpen)
            {
                yield break;
            }
            yield return packet;
        }
    }

    /// <summary>Calls these for the packets that wait and those that come, in order, one at a time; null takes them away.</summary>
    /// <param name="onPacket">Gets each packet, which is then not kept; null: they are kept.</param>
    /// <param name="onClosed">Once, behind the packets.</param>
    /// <param name="onAcknowledged">Numbers of packets that the other side has, of those that are acknowledged.</param>
    public unsafe void SetHandler(Action<T>? onPacket, Action? onClosed = null, Action<uint>? onAcknowledged = null)
    {
        nint error;
        if (onPacket is null && onClosed is null && onAcknowledged is null)
        {
            Failure.Check(Functions.rr_pipe_set_handler(_handle, null, &error), error, _types);
            return;
        }
        var native = new RrPipeHandler
        {
            Size = (nuint)sizeof(RrPipeHandler),
            Context = Context.Of(new PipeSink<T>(_types, _codec, onPacket, onClosed, onAcknowledged)),
            OnPacket = onPacket is null ? null : &PipeSink.OnPacket,
            OnAcknowledged = onAcknowledged is null ? null : &PipeSink.OnAcknowledged,
            OnClosed = &PipeSink.OnClosed,
            Drop = &Context.Drop,
        };
        Failure.Check(Functions.rr_pipe_set_handler(_handle, &native, &error), error, _types);
    }

    /// <summary>Disconnects. A client waits for the service's answer for half a second at most.</summary>
    public void Close() => Functions.rr_pipe_close(_handle);

    /// <summary>Disconnects, and lets go of the end.</summary>
    public void Dispose()
    {
        if (!_handle.IsClosed)
        {
            Close();
            _handle.Dispose();
        }
    }
}

/// <summary>Where the native runtime brings what comes through one end of a pipe.</summary>
internal abstract unsafe class PipeSink
{
    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnPacket(nint context, RrElements* packet, nint data) =>
        Guard(context, *packet, static (sink, elements) => sink.Receive(elements));

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnAcknowledged(nint context, uint number) =>
        Guard(context, number, static (sink, one) => sink.Acknowledge(one));

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnClosed(nint context) => Guard(context, 0, static (sink, _) => sink.Close());

    protected abstract void Receive(in RrElements packet);

    protected abstract void Acknowledge(uint number);

    protected abstract void Close();

    private static void Guard<T>(nint context, T argument, Action<PipeSink, T> run)
    {
        try
        {
            run(Context.Get<PipeSink>(context), argument);
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }
}

internal sealed class PipeSink<T>(KnownTypes types, ValueCodec<T> codec, Action<T>? onPacket, Action? onClosed,
    Action<uint>? onAcknowledged) : PipeSink
{
    protected override void Receive(in RrElements packet) =>
        onPacket?.Invoke(codec.Read(Elements.Reader(packet, types.Registry).Read()));

    protected override void Acknowledge(uint number) => onAcknowledged?.Invoke(number);

    protected override void Close() => onClosed?.Invoke();
}
