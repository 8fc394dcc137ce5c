// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

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

    /// <summary>What the native runtime calls; the context is freed when it will not any more.</summary>
    public static RrMemoryPieces Native(nint context) => new()
    {
        Size = (nuint)sizeof(RrMemoryPieces),
        Context = context,
        Take = &OnTake,
        Give = &OnGive,
    };

    protected abstract void Take(ulong offset, ReadOnlySpan<ulong> count, in RrElements data);

    protected abstract int Give(ulong offset, ReadOnlySpan<ulong> count, nint piece);

    private int Fail(Exception exception)
    {
        Failed = exception as RobdefException ?? new UnknownException(exception.Message, innerException: exception);
        return (int)Failed.Code;
    }
}

internal sealed unsafe class MemoryPieces<T>(ItemCodec<T> codec, ObjectHandle target, Memory<T> items, ulong[] whole, bool isMulti) : MemoryPieces
{
    protected override void Take(ulong offset, ReadOnlySpan<ulong> count, in RrElements data)
    {
        Element element = Elements.Reader(data, target.Types.Registry).Read();
        T[] piece = isMulti ? codec.MultiDim.Read(element).Items : codec.Array.Read(element);
        int next = 0;
        foreach (Run run in new Runs(offset, count, whole))
        {
            piece.AsSpan(next, run.Length).CopyTo(items.Span[run.Begin..]);
            next += run.Length;
        }
    }

    protected override int Give(ulong offset, ReadOnlySpan<ulong> count, nint piece)
    {
        var part = new T[Runs.Product(count)];
        int next = 0;
        foreach (Run run in new Runs(offset, count, whole))
        {
            items.Span.Slice(run.Begin, run.Length).CopyTo(part.AsSpan(next));
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
