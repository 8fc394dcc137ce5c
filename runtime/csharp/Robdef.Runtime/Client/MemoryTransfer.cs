// SPDX-License-Identifier: Apache-2.0
using System;
using System.Buffers;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>Moves parts of a memory: numbers as they lie in memory, others piece by piece.</summary>
internal sealed unsafe class MemoryTransfer<T>(Stub stub, string member, MemberAccess access, ItemCodec<T> codec, bool isMulti)
{
    private const uint GetParameter = 1175;

    private readonly ObjectHandle _object = stub.RrHandle;
    private readonly byte[] _name = System.Text.Encoding.UTF8.GetBytes(member);

    private bool IsNumbers => codec.TypeName.IsEmpty;

    public Task<ulong> AskAsync(string what, CancellationToken cancel) => Question(what).RunAsync(ValueCodec.UInt64, cancel);

    public ulong Ask(string what, CancellationToken cancel) => Question(what).Run(ValueCodec.UInt64, cancel);

    public Task<ulong[]> AskDimsAsync(CancellationToken cancel) => Question("Dimensions").RunAsync(ValueCodec.UInt64.Array, cancel);

    public ulong[] AskDims(CancellationToken cancel) => Question("Dimensions").Run(ValueCodec.UInt64.Array, cancel);

    public void Read(ReadOnlySpan<ulong> position, ReadOnlySpan<ulong> count, Span<T> items)
    {
        using RemoteUse target = _object.Use();
        ArgumentOutOfRangeException.ThrowIfNotEqual(count.Length, position.Length);
        using var name = new NativeText(member);
        RrMemoryType type = Type;
        nint error;
        fixed (ulong* where = position, many = count)
        {
            if (IsNumbers)
            {
                fixed (byte* first = Bytes(items))
                {
                    int status = Functions.rr_memory_read(target.Native, name.Value, &type, where, many, (nuint)position.Length,
                        first, (nuint)((long)items.Length * Unsafe.SizeOf<T>()), null, &error);
                    Failure.Check(status, error, _object.Types);
                }
                return;
            }
            RemoteHandle remote = target.Native;
            var buffer = new T[items.Length];
            var pieces = new MemoryPieces<T>(codec, _object, buffer, count.ToArray(), isMulti);
            Transfer(pieces, native => Functions.rr_memory_read_pieces(remote, native.Name, native.Type, native.Position, native.Count,
                native.Dims, native.Pieces, null, native.Error), name.Value, &type, where, many, position.Length);
            buffer.CopyTo(items);
        }
    }

    public void Write(ReadOnlySpan<ulong> position, ReadOnlySpan<ulong> count, ReadOnlySpan<T> items)
    {
        using RemoteUse target = _object.Use();
        ArgumentOutOfRangeException.ThrowIfNotEqual(count.Length, position.Length);
        using var name = new NativeText(member);
        RrMemoryType type = Type;
        nint error;
        fixed (ulong* where = position, many = count)
        {
            if (IsNumbers)
            {
                fixed (byte* first = Bytes(items))
                {
                    int status = Functions.rr_memory_write(target.Native, name.Value, &type, where, many, (nuint)position.Length,
                        first, (nuint)((long)items.Length * Unsafe.SizeOf<T>()), null, &error);
                    Failure.Check(status, error, _object.Types);
                }
                return;
            }
            RemoteHandle remote = target.Native;
            var pieces = new MemoryPieces<T>(codec, _object, items.ToArray(), count.ToArray(), isMulti);
            Transfer(pieces, native => Functions.rr_memory_write_pieces(remote, native.Name, native.Type, native.Position, native.Count,
                native.Dims, native.Pieces, null, native.Error), name.Value, &type, where, many, position.Length);
        }
    }

    /// <summary>Items stay where they are until it has ended, which it does with a cancellation too.</summary>
    public Task ReadAsync(ulong[] position, ulong[] count, Memory<T> items, CancellationToken cancel) => IsNumbers
        ? MoveAsync(isRead: true, position, count, items, cancel)
        : MovePiecesAsync(isRead: true, position, count, items, cancel);

    public Task WriteAsync(ulong[] position, ulong[] count, ReadOnlyMemory<T> items, CancellationToken cancel) => IsNumbers
        ? MoveAsync(isRead: false, position, count, items, cancel)
        : MovePiecesAsync(isRead: false, position, count, MemoryMarshal.AsMemory(items), cancel);

    private Task MoveAsync(bool isRead, ulong[] position, ulong[] count, ReadOnlyMemory<T> items, CancellationToken cancel)
    {
        ArgumentOutOfRangeException.ThrowIfNotEqual(count.Length, position.Length);
        if (_object.Refusal<bool>(cancel) is { } refused)
        {
            return refused;
        }
        using RemoteUse target = _object.Use();
        var completion = new TaskCompletion<bool>(_object.Types, static _ => true, cancel);
        MemoryHandle pinned = items.Pin();
        RrMemoryType type = Type;
        var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Cancellation = completion.Cancellation };
        RrCompletion native = completion.Native;
        nint error;
        int status;
        nuint size = (nuint)((long)items.Length * Unsafe.SizeOf<T>());
        fixed (byte* name = _name)
        fixed (ulong* where = position, many = count)
        {
            var memberName = new RrStr { Data = name, Size = (nuint)_name.Length };
            status = isRead
                ? Functions.rr_memory_read_async(target.Native, memberName, &type, where, many, (nuint)position.Length, pinned.Pointer, size, &options, &native, &error)
                : Functions.rr_memory_write_async(target.Native, memberName, &type, where, many, (nuint)position.Length, pinned.Pointer, size, &options, &native, &error);
        }
        Task task = status == 0 ? completion.Task : Task.FromException(completion.Abandon(native, status, error));
        task.ContinueWith(static (_, place) => ((MemoryHandle)place!).Dispose(), pinned, CancellationToken.None,
            TaskContinuationOptions.ExecuteSynchronously, TaskScheduler.Default);
        return task;
    }

    private Task MovePiecesAsync(bool isRead, ulong[] position, ulong[] count, Memory<T> items, CancellationToken cancel)
    {
        ArgumentOutOfRangeException.ThrowIfNotEqual(count.Length, position.Length);
        if (_object.Refusal<bool>(cancel) is { } refused)
        {
            return refused;
        }
        using RemoteUse target = _object.Use();
        var pieces = new MemoryPieces<T>(codec, _object, items, count, isMulti);
        var completion = new TaskCompletion<bool>(_object.Types, static _ => true, cancel);
        nint context = Context.Of(pieces);
        RrMemoryPieces called = MemoryPieces.Native(context);
        RrMemoryType type = Type;
        var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Cancellation = completion.Cancellation };
        RrCompletion native = completion.Native;
        nint error;
        int status;
        fixed (byte* name = _name)
        fixed (ulong* where = position, many = count)
        {
            var memberName = new RrStr { Data = name, Size = (nuint)_name.Length };
            status = isRead
                ? Functions.rr_memory_read_pieces_async(target.Native, memberName, &type, where, many, (nuint)position.Length, &called, &options, &native, &error)
                : Functions.rr_memory_write_pieces_async(target.Native, memberName, &type, where, many, (nuint)position.Length, &called, &options, &native, &error);
        }
        return PieceEnds.After(status == 0 ? completion.Task : Task.FromException(completion.Abandon(native, status, error)), pieces, context);
    }

    private Call Question(string what) => new Call(_object, _name, GetParameter, MemberAccess.None)
        .With("parameter"u8, ValueCodec.String, what);

    private RrMemoryType Type => new()
    {
        Element = (uint)codec.ArrayType,
        IsMulti = isMulti ? 1u : 0,
        Access = (uint)access,
        TransferSize = codec.TransferSize,
    };

    /// <summary>The bytes of numbers; only called for these.</summary>
    private static Span<byte> Bytes(ReadOnlySpan<T> items) =>
        MemoryMarshal.CreateSpan(ref Unsafe.As<T, byte>(ref MemoryMarshal.GetReference(items)), items.Length * Unsafe.SizeOf<T>());

    private void Transfer(MemoryPieces pieces, Func<PieceArguments, int> run, RrStr name, RrMemoryType* type, ulong* position,
        ulong* count, int dims)
    {
        nint context = Context.Of(pieces);
        try
        {
            RrMemoryPieces native = MemoryPieces.Native(context);
            nint error = 0;
            int status = run(new PieceArguments(name, type, position, count, (nuint)dims, &native, &error));
            if (status != 0)
            {
                RobdefException failure = Failure.Take(status, error, _object.Types);
                throw pieces.Failed ?? failure;
            }
        }
        finally
        {
            Context.Free(context);
        }
    }
}

/// <summary>What is left to do when the last piece has gone.</summary>
internal static class PieceEnds
{
    /// <summary>Frees the context; what a function of the program has thrown comes instead of what the native runtime made of it.</summary>
    public static async Task After(Task transfer, MemoryPieces pieces, nint context)
    {
        try
        {
            await transfer.ConfigureAwait(false);
        }
        catch (RobdefException) when (pieces.Failed is not null)
        {
            throw pieces.Failed;
        }
        finally
        {
            Context.Free(context);
        }
    }
}
