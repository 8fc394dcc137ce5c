// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>A memory of one dimension of an object on another node.</summary>
/// <typeparam name="T">One item.</typeparam>
public sealed class ArrayMemory<T>
{
    private readonly MemoryTransfer<T> _transfer;

    /// <summary>The memory of a stub.</summary>
    public ArrayMemory(Stub stub, string member, MemberAccess access, ItemCodec<T> codec) =>
        _transfer = new MemoryTransfer<T>(stub, member, access, codec, isMulti: false);

    /// <summary>Asks how many items there are.</summary>
    public long GetLength() => _transfer.Length();

    /// <summary>Asks how many items there are.</summary>
    public Task<long> GetLengthAsync(CancellationToken cancel = default) => Task.Run(GetLength, cancel);

    /// <summary>Reads as many items as the span has, from a position on, in as many requests as it takes.</summary>
    public void Read(long position, Span<T> items) => _transfer.Read([(ulong)position], [(ulong)items.Length], items);

    /// <summary>Writes items to a position.</summary>
    public void Write(long position, ReadOnlySpan<T> items) => _transfer.Write([(ulong)position], [(ulong)items.Length], items);

    /// <summary>Reads as many items as there is room for. Cancelled before it begins, never in between.</summary>
    public Task ReadAsync(long position, Memory<T> items, CancellationToken cancel = default) =>
        Task.Run(() => Read(position, items.Span), cancel);

    /// <summary>Writes items to a position. Cancelled before it begins, never in between.</summary>
    public Task WriteAsync(long position, ReadOnlyMemory<T> items, CancellationToken cancel = default) =>
        Task.Run(() => Write(position, items.Span), cancel);
}

/// <summary>A memory of several dimensions of an object on another node. The first dimension varies fastest.</summary>
/// <typeparam name="T">One item.</typeparam>
public sealed class MultiDimMemory<T>
{
    private readonly MemoryTransfer<T> _transfer;

    /// <summary>The memory of a stub.</summary>
    public MultiDimMemory(Stub stub, string member, MemberAccess access, ItemCodec<T> codec) =>
        _transfer = new MemoryTransfer<T>(stub, member, access, codec, isMulti: true);

    /// <summary>Asks for the size in each dimension.</summary>
    public long[] GetDims() => _transfer.Dims();

    /// <summary>Asks for the size in each dimension.</summary>
    public Task<long[]> GetDimsAsync(CancellationToken cancel = default) => Task.Run(GetDims, cancel);

    /// <summary>Reads a part into a span that has exactly its items.</summary>
    public void Read(ReadOnlySpan<long> position, ReadOnlySpan<long> count, Span<T> items) =>
        _transfer.Read(MemoryMarshal.Cast<long, ulong>(position), MemoryMarshal.Cast<long, ulong>(count), items);

    /// <summary>Writes a part from a span that has exactly its items.</summary>
    public void Write(ReadOnlySpan<long> position, ReadOnlySpan<long> count, ReadOnlySpan<T> items) =>
        _transfer.Write(MemoryMarshal.Cast<long, ulong>(position), MemoryMarshal.Cast<long, ulong>(count), items);

    /// <summary>Reads a part. Cancelled before it begins, never in between.</summary>
    public Task ReadAsync(long[] position, long[] count, Memory<T> items, CancellationToken cancel = default) =>
        Task.Run(() => Read(position, count, items.Span), cancel);

    /// <summary>Writes a part. Cancelled before it begins, never in between.</summary>
    public Task WriteAsync(long[] position, long[] count, ReadOnlyMemory<T> items, CancellationToken cancel = default) =>
        Task.Run(() => Write(position, count, items.Span), cancel);
}

/// <summary>Moves parts of a memory: numbers as they lie in memory, others piece by piece.</summary>
internal sealed unsafe class MemoryTransfer<T>(Stub stub, string member, MemberAccess access, ItemCodec<T> codec, bool isMulti)
{
    private const int MostDims = 32;

    private readonly ObjectHandle _object = stub.RrHandle;

    private bool IsNumbers => codec.TypeName.IsEmpty;

    public long Length()
    {
        using var name = new NativeText(member);
        nint error;
        Failure.Check(Functions.rr_memory_length(_object.Native, name.Value, null, out ulong length, &error), error, _object.Types);
        return (long)length;
    }

    public long[] Dims()
    {
        using var name = new NativeText(member);
        ulong* dims = stackalloc ulong[MostDims];
        nuint count = MostDims;
        nint error;
        Failure.Check(Functions.rr_memory_dims(_object.Native, name.Value, null, dims, &count, &error), error, _object.Types);
        long[] result = new long[Math.Min((int)count, MostDims)];
        for (int i = 0; i < result.Length; ++i)
        {
            result[i] = (long)dims[i];
        }
        return result;
    }

    public void Read(ReadOnlySpan<ulong> position, ReadOnlySpan<ulong> count, Span<T> items)
    {
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
                    int status = Functions.rr_memory_read(_object.Native, name.Value, &type, where, many, (nuint)position.Length,
                        first, (nuint)((long)items.Length * Unsafe.SizeOf<T>()), null, &error);
                    Failure.Check(status, error, _object.Types);
                }
                return;
            }
            var buffer = new T[items.Length];
            var pieces = new MemoryPieces<T>(codec, _object, buffer, count.ToArray(), isMulti);
            Transfer(pieces, native => Functions.rr_memory_read_pieces(_object.Native, native.Name, native.Type, native.Position, native.Count,
                native.Dims, native.Pieces, null, native.Error), name.Value, &type, where, many, position.Length);
            buffer.CopyTo(items);
        }
    }

    public void Write(ReadOnlySpan<ulong> position, ReadOnlySpan<ulong> count, ReadOnlySpan<T> items)
    {
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
                    int status = Functions.rr_memory_write(_object.Native, name.Value, &type, where, many, (nuint)position.Length,
                        first, (nuint)((long)items.Length * Unsafe.SizeOf<T>()), null, &error);
                    Failure.Check(status, error, _object.Types);
                }
                return;
            }
            var pieces = new MemoryPieces<T>(codec, _object, items.ToArray(), count.ToArray(), isMulti);
            Transfer(pieces, native => Functions.rr_memory_write_pieces(_object.Native, native.Name, native.Type, native.Position, native.Count,
                native.Dims, native.Pieces, null, native.Error), name.Value, &type, where, many, position.Length);
        }
    }

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
            var native = new RrMemoryPieces
            {
                Size = (nuint)sizeof(RrMemoryPieces),
                Context = context,
                Take = &MemoryPieces.OnTake,
                Give = &MemoryPieces.OnGive,
            };
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

/// <summary>What a transfer by pieces is called with.</summary>
internal readonly unsafe struct PieceArguments(RrStr name, RrMemoryType* type, ulong* position, ulong* count, nuint dims,
    RrMemoryPieces* pieces, nint* error)
{
    public RrStr Name => name;

    public RrMemoryType* Type => type;

    public ulong* Position => position;

    public ulong* Count => count;

    public nuint Dims => dims;

    public RrMemoryPieces* Pieces => pieces;

    public nint* Error => error;
}

/// <summary>The pieces of one transfer of pods or namedarrays, which come as elements.</summary>
internal abstract unsafe class MemoryPieces
{
    public RobdefException? Failed { get; private set; }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static int OnTake(nint context, ulong offset, ulong* count, nuint dims, RrElements* data)
    {
        var pieces = Context.Get<MemoryPieces>(context);
        try
        {
            pieces.Take(offset, new ReadOnlySpan<ulong>(count, (int)dims), *data);
            return 0;
        }
        catch (Exception exception)
        {
            return pieces.Fail(exception);
        }
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static int OnGive(nint context, ulong offset, ulong* count, nuint dims, nint piece)
    {
        var pieces = Context.Get<MemoryPieces>(context);
        try
        {
            return pieces.Give(offset, new ReadOnlySpan<ulong>(count, (int)dims), piece);
        }
        catch (Exception exception)
        {
            return pieces.Fail(exception);
        }
    }

    protected abstract void Take(ulong offset, ReadOnlySpan<ulong> count, in RrElements data);

    protected abstract int Give(ulong offset, ReadOnlySpan<ulong> count, nint piece);

    private int Fail(Exception exception)
    {
        Failed = exception as RobdefException ?? new RobdefException(exception.Message, exception);
        return (int)Failed.Code;
    }
}

internal sealed unsafe class MemoryPieces<T>(ItemCodec<T> codec, ObjectHandle target, T[] items, ulong[] whole, bool isMulti) : MemoryPieces
{
    protected override void Take(ulong offset, ReadOnlySpan<ulong> count, in RrElements data)
    {
        Element element = Elements.Reader(data, target.Types.Registry).Read();
        T[] piece = isMulti ? codec.MultiDim.Read(element).Items : codec.Array.Read(element);
        int next = 0;
        foreach (Run run in new Runs(offset, count, whole))
        {
            piece.AsSpan(next, run.Length).CopyTo(items.AsSpan(run.Begin));
            next += run.Length;
        }
    }

    protected override int Give(ulong offset, ReadOnlySpan<ulong> count, nint piece)
    {
        var part = new T[Runs.Product(count)];
        int next = 0;
        foreach (Run run in new Runs(offset, count, whole))
        {
            items.AsSpan(run.Begin, run.Length).CopyTo(part.AsSpan(next));
            next += run.Length;
        }
        ElementWriter writer = Writers.Rent(target.Version);
        if (isMulti)
        {
            codec.MultiDim.Write(writer, "data"u8, new MultiDimArray<T>(Array.ConvertAll(count.ToArray(), static dim => (int)dim), part));
        }
        else
        {
            codec.Array.Write(writer, "data"u8, part);
        }
        fixed (byte* first = writer.Written)
        {
            RrElements elements = Elements.Of(first, writer);
            int status = Functions.rr_piece_set(piece, &elements, null);
            Writers.Return(writer);
            return status;
        }
    }
}

/// <summary>Items that lie behind each other.</summary>
internal readonly record struct Run(int Begin, int Length);

/// <summary>The runs of a block inside a larger array, the first dimension varying fastest.</summary>
internal ref struct Runs
{
    private readonly ReadOnlySpan<ulong> _count;
    private readonly ReadOnlySpan<ulong> _whole;
    private readonly ulong _offset;
    private readonly int _runs;
    private int _next;

    public Runs(ulong offset, ReadOnlySpan<ulong> count, ReadOnlySpan<ulong> whole)
    {
        _offset = offset;
        _count = count;
        _whole = whole;
        _runs = count[0] == 0 ? 0 : Product(count[1..]);
    }

    public Run Current { get; private set; }

    public static int Product(ReadOnlySpan<ulong> count)
    {
        ulong product = 1;
        foreach (ulong one in count)
        {
            product = checked(product * one);
        }
        return checked((int)product);
    }

    public readonly Runs GetEnumerator() => this;

    public bool MoveNext()
    {
        if (_next == _runs)
        {
            return false;
        }
        ulong rest = (ulong)_next++;
        ulong begin = _offset;
        ulong stride = _whole[0];
        for (int i = 1; i < _count.Length; ++i)
        {
            begin += rest % _count[i] * stride;
            rest /= _count[i];
            stride *= _whole[i];
        }
        Current = new Run(checked((int)begin), (int)_count[0]);
        return true;
    }
}
