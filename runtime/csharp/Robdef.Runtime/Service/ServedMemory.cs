// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>A memory as the native runtime uses it.</summary>
public abstract unsafe class ServedMemory
{
    private protected ServedMemory()
    {
    }

    internal abstract bool IsNumbers { get; }

    /// <summary>A memory of one dimension.</summary>
    public static ServedMemory Of<T>(ArrayMemorySource<T> source, ItemCodec<T> codec) => new ServedArrayMemory<T>(source, codec);

    /// <summary>A memory of several dimensions.</summary>
    public static ServedMemory Of<T>(MultiDimMemorySource<T> source, ItemCodec<T> codec) => new ServedMultiDimMemory<T>(source, codec);

    internal TypeRegistry Registry { get; private set; } = TypeRegistry.Empty;

    internal void Set(ServedHandle served, uint member, KnownTypes types)
    {
        Registry = types.Registry;
        var native = new RrMemorySource
        {
            Size = (nuint)sizeof(RrMemorySource),
            Context = Context.Of(this),
            Dims = &OnDims,
            Read = IsNumbers ? &OnRead : null,
            Write = IsNumbers ? &OnWrite : null,
            ReadPiece = IsNumbers ? null : &OnReadPiece,
            WritePiece = IsNumbers ? null : &OnWritePiece,
            Drop = &Context.Drop,
        };
        nint error;
        Failure.Check(Functions.rr_served_memory_set(served, member, &native, &error), error, types);
    }

    internal abstract ReadOnlySpan<long> AllDims();

    internal abstract void Read(ReadOnlySpan<long> position, ReadOnlySpan<long> count, Span<byte> items);

    internal abstract void Write(ReadOnlySpan<long> position, ReadOnlySpan<long> count, ReadOnlySpan<byte> items);

    internal abstract void ReadPiece(ReadOnlySpan<long> position, ReadOnlySpan<long> count, ElementWriter writer);

    internal abstract void WritePiece(ReadOnlySpan<long> position, ReadOnlySpan<long> count, scoped in Element data);

    private static int Code(Exception exception) => exception is RobdefException error
        ? (int)error.Code
        : (int)ErrorCode.OperationFailed;

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    private static int OnDims(nint context, ulong* dims, nuint room, nuint* count)
    {
        try
        {
            ReadOnlySpan<long> all = Context.Get<ServedMemory>(context).AllDims();
            *count = (nuint)all.Length;
            for (int i = 0; i < Math.Min(all.Length, (int)room); ++i)
            {
                dims[i] = (ulong)all[i];
            }
            return 0;
        }
        catch (Exception exception)
        {
            return Code(exception);
        }
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    private static int OnRead(nint context, ulong* position, ulong* count, nuint dims, void* items, nuint size)
    {
        try
        {
            Context.Get<ServedMemory>(context).Read(new((long*)position, (int)dims), new((long*)count, (int)dims), new(items, (int)size));
            return 0;
        }
        catch (Exception exception)
        {
            return Code(exception);
        }
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    private static int OnWrite(nint context, ulong* position, ulong* count, nuint dims, void* items, nuint size)
    {
        try
        {
            Context.Get<ServedMemory>(context).Write(new((long*)position, (int)dims), new((long*)count, (int)dims), new(items, (int)size));
            return 0;
        }
        catch (Exception exception)
        {
            return Code(exception);
        }
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    private static int OnReadPiece(nint context, ulong* position, ulong* count, nuint dims, nint piece)
    {
        try
        {
            ElementWriter writer = Writers.Rent(MessageVersion.V4);
            Context.Get<ServedMemory>(context).ReadPiece(new((long*)position, (int)dims), new((long*)count, (int)dims), writer);
            fixed (byte* first = writer.Written)
            {
                RrElements elements = Elements.Of(first, writer);
                int status = Functions.rr_piece_set(piece, &elements, null);
                Writers.Return(writer);
                return status;
            }
        }
        catch (Exception exception)
        {
            return Code(exception);
        }
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    private static int OnWritePiece(nint context, ulong* position, ulong* count, nuint dims, RrElements* data)
    {
        try
        {
            ServedMemory memory = Context.Get<ServedMemory>(context);
            Element element = Elements.Reader(*data, memory.Registry).Read();
            memory.WritePiece(new((long*)position, (int)dims), new((long*)count, (int)dims), element);
            return 0;
        }
        catch (Exception exception)
        {
            return Code(exception);
        }
    }
}

/// <summary>Numbers as bytes and back; only where items are numbers.</summary>
internal static class ItemBytes
{
    public static Span<T> As<T>(ReadOnlySpan<byte> bytes) =>
        MemoryMarshal.CreateSpan(ref Unsafe.As<byte, T>(ref MemoryMarshal.GetReference(bytes)), bytes.Length / Unsafe.SizeOf<T>());
}

internal sealed class ServedArrayMemory<T>(ArrayMemorySource<T> source, ItemCodec<T> codec) : ServedMemory
{
    internal override bool IsNumbers => codec.TypeName.IsEmpty;

    internal override ReadOnlySpan<long> AllDims() => new long[] { source.Length };

    internal override void Read(ReadOnlySpan<long> position, ReadOnlySpan<long> count, Span<byte> items) =>
        source.Read(position[0], ItemBytes.As<T>(items));

    internal override void Write(ReadOnlySpan<long> position, ReadOnlySpan<long> count, ReadOnlySpan<byte> items) =>
        source.Write(position[0], ItemBytes.As<T>(items));

    internal override void ReadPiece(ReadOnlySpan<long> position, ReadOnlySpan<long> count, ElementWriter writer)
    {
        var items = new T[checked((int)count[0])];
        source.Read(position[0], items);
        codec.WriteItems(writer, "data"u8, items);
    }

    internal override void WritePiece(ReadOnlySpan<long> position, ReadOnlySpan<long> count, scoped in Element data)
    {
        T[] items = codec.ReadItems(data);
        ArgumentOutOfRangeException.ThrowIfNotEqual(items.Length, count[0]);
        source.Write(position[0], items);
    }
}

internal sealed class ServedMultiDimMemory<T>(MultiDimMemorySource<T> source, ItemCodec<T> codec) : ServedMemory
{
    internal override bool IsNumbers => codec.TypeName.IsEmpty;

    internal override ReadOnlySpan<long> AllDims() => source.Dims;

    internal override void Read(ReadOnlySpan<long> position, ReadOnlySpan<long> count, Span<byte> items) =>
        source.Read(position, count, ItemBytes.As<T>(items));

    internal override void Write(ReadOnlySpan<long> position, ReadOnlySpan<long> count, ReadOnlySpan<byte> items) =>
        source.Write(position, count, ItemBytes.As<T>(items));

    internal override void ReadPiece(ReadOnlySpan<long> position, ReadOnlySpan<long> count, ElementWriter writer)
    {
        int[] dims = Array.ConvertAll(count.ToArray(), static dim => checked((int)dim));
        var items = new MultiDimArray<T>(dims);
        source.Read(position, count, items.Items);
        codec.MultiDim.Write(writer, "data"u8, items);
    }

    internal override void WritePiece(ReadOnlySpan<long> position, ReadOnlySpan<long> count, scoped in Element data) =>
        source.Write(position, count, codec.MultiDim.Read(data).Items);
}
