// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;

namespace Robdef.Runtime;

/// <summary>A number, complex or truth: packed as it lies in memory.</summary>
internal sealed class NumberCodec<T>(ElementType type) : ItemCodec<T>
    where T : unmanaged
{
    internal override ElementType ArrayType => type;

    internal override ElementType MultiDimType => ElementType.MultiDimArray;

    internal override ReadOnlySpan<byte> TypeName => default;

    internal override bool ArePacked => true;

    internal override uint TransferSize => (uint)Unsafe.SizeOf<T>();

    public override T Read(scoped in Element element)
    {
        element.Expect(type);
        if (element.Count == 0)
        {
            throw element.Error(ErrorCode.OutOfRange, "holds no number");
        }
        T value = MemoryMarshal.Read<T>(element.Payload);
        Packed.Normalize(new Span<T>(ref value));
        return value;
    }

    public override void WriteItems(ElementWriter writer, scoped in ElementKey key, scoped ReadOnlySpan<T> items)
    {
        int begin = writer.BeginElement();
        Packed.Write(writer, items);
        writer.EndElement(begin, key, type, default, items.Length);
    }

    internal override void WriteArray(ElementWriter writer, scoped in ElementKey key, T[] items) =>
        writer.PrependArray(key, type, items, items.Length);

    public override int CountItems(scoped in Element element)
    {
        element.Expect(type);
        return element.Count;
    }

    public override void ReadItems(scoped in Element element, Span<T> items) => Packed.Read(element.Payload, items);
}

/// <summary>Arrays of plain memory.</summary>
internal static class Packed
{
    public static void Write<T>(ElementWriter writer, scoped ReadOnlySpan<T> items)
        where T : unmanaged
    {
        if ((long)items.Length * Unsafe.SizeOf<T>() > Array.MaxLength)
        {
            throw new BufferLimitViolationException("an array is too large to be sent");
        }
        writer.Prepend(MemoryMarshal.AsBytes(items));
    }

    public static void Read<T>(ReadOnlySpan<byte> payload, Span<T> items)
        where T : unmanaged
    {
        payload.CopyTo(MemoryMarshal.AsBytes(items));
        Normalize(items);
    }

    /// <summary>A truth is any byte but 0 on the wire, and only 1 in C#.</summary>
    public static void Normalize<T>(Span<T> items)
        where T : unmanaged
    {
        if (typeof(T) != typeof(bool))
        {
            return;
        }
        foreach (ref byte truth in MemoryMarshal.AsBytes(items))
        {
            truth = truth == 0 ? (byte)0 : (byte)1;
        }
    }
}
