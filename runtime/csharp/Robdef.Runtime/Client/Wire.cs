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

/// <summary>Values of wires as the native runtime gives them.</summary>
internal static class WireValues
{
    /// <summary>False when the status says that there is none; throws for any other failure.</summary>
    public static bool TryTake<T>(int status, nint error, nint data, in RrTime time, ValueCodec<T> codec, KnownTypes types, out WireValue<T> value)
    {
        if (status == (int)ErrorCode.ValueNotSet)
        {
            _ = Failure.Take(status, error, types);
            value = default;
            return false;
        }
        Failure.Check(status, error, types);
        value = new WireValue<T>(Elements.Take(data, codec, types.Registry), Times.ToDateTime(time));
        return true;
    }
}

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
        using RemoteUse target = _object.Use();
        using var name = new NativeText(_member);
        nint error;
        int status = Functions.rr_wire_connect(target.Native, name.Value, (uint)_access, null, out nint wire, &error);
        Failure.Check(status, error, _object.Types);
        return new WireConnection<T>(new WireHandle(wire), _object.Types, _object.Version, _codec, isClient: true);
    }

    /// <summary>Connects. InvalidOperation when this client has connected it already.</summary>
    public unsafe Task<WireConnection<T>> ConnectAsync(CancellationToken cancel = default)
    {
        if (_object.Refusal<WireConnection<T>>(cancel) is { } refused)
        {
            return refused;
        }
        using RemoteUse target = _object.Use();
        KnownTypes types = _object.Types;
        MessageVersion version = _object.Version;
        var completion = new TaskCompletion<WireConnection<T>>(types, wire => new WireConnection<T>(new WireHandle(wire), types, version, _codec, isClient: true), cancel);
        using var name = new NativeText(_member);
        var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Cancellation = completion.Cancellation };
        RrCompletion native = completion.Native;
        nint error;
        int status = Functions.rr_wire_connect_async(target.Native, name.Value, (uint)_access, &options, &native, &error);
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
        using RemoteUse target = _object.Use();
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
            int status = Functions.rr_wire_poke_out(target.Native, name.Value, &elements, &options, &error);
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
        if (_object.Refusal<bool>(cancel) is { } refused)
        {
            return refused;
        }
        using RemoteUse target = _object.Use();
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
            int status = Functions.rr_wire_poke_out_async(target.Native, name.Value, &elements, &options, &native, &error);
            Writers.Return(writer);
            return status == 0 ? completion.Task : Task.FromException(completion.Abandon(native, status, error));
        }
    }

    private unsafe WireValue<T> Peek(bool isIn, CancellationToken cancel)
    {
        using RemoteUse target = _object.Use();
        var cancellation = new NativeCancellation(cancel);
        cancellation.Begin();
        using var name = new NativeText(_member);
        var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Cancellation = cancellation.Handle };
        RrTime time;
        nint error;
        nint data;
        int status = isIn
            ? Functions.rr_wire_peek_in(target.Native, name.Value, &options, out data, &time, &error)
            : Functions.rr_wire_peek_out(target.Native, name.Value, &options, out data, &time, &error);
        cancellation.End();
        return status == 0
            ? new WireValue<T>(Elements.Take(data, _codec, _object.Types.Registry), Times.ToDateTime(time))
            : throw cancellation.Failed(Failure.Take(status, error, _object.Types));
    }

    private unsafe Task<WireValue<T>> PeekAsync(bool isIn, CancellationToken cancel)
    {
        if (_object.Refusal<WireValue<T>>(cancel) is { } refused)
        {
            return refused;
        }
        using RemoteUse target = _object.Use();
        // The native side writes the time before it completes, so its place must not move.
        nint time = (nint)NativeMemory.AllocZeroed((nuint)sizeof(RrTime));
        TypeRegistry registry = _object.Types.Registry;
        var completion = new TaskCompletion<WireValue<T>>(_object.Types, data => new WireValue<T>(Elements.Take(data, _codec, registry), Times.ToDateTime(*(RrTime*)time)), cancel);
        using var name = new NativeText(_member);
        var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Cancellation = completion.Cancellation };
        RrCompletion native = completion.Native;
        nint error;
        int status = isIn
            ? Functions.rr_wire_peek_in_async(target.Native, name.Value, &options, (RrTime*)time, &native, &error)
            : Functions.rr_wire_peek_out_async(target.Native, name.Value, &options, (RrTime*)time, &native, &error);
        Task<WireValue<T>> task = status == 0
            ? completion.Task
            : Task.FromException<WireValue<T>>(completion.Abandon(native, status, error));
        task.ContinueWith(static (_, place) => NativeMemory.Free((void*)(nint)place!), time, CancellationToken.None,
            TaskContinuationOptions.ExecuteSynchronously, TaskScheduler.Default);
        return task;
    }
}
