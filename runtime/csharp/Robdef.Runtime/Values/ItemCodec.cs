// SPDX-License-Identifier: Apache-2.0
using System;

namespace Robdef.Runtime;

/// <summary>
/// The codec of a type that may stand in arrays and memories: numbers, pods, namedarrays. It is
/// itself that of a single item.
/// </summary>
/// <typeparam name="T">The item.</typeparam>
public abstract class ItemCodec<T> : ValueCodec<T>
{
    private ValueCodec<T[]>? _array;
    private ValueCodec<MultiDimArray<T>>? _multiDim;

    /// <summary>Of `T[]`.</summary>
    public ValueCodec<T[]> Array => _array ??= new ArrayCodec<T>(this, 0, int.MaxValue);

    /// <summary>Of `T[*]`.</summary>
    public ValueCodec<MultiDimArray<T>> MultiDim => _multiDim ??= new MultiDimCodec<T>(this, null);

    /// <summary>The type of an element that holds an array of them.</summary>
    internal abstract ElementType ArrayType { get; }

    /// <summary>The type of an element that holds an array of several dimensions.</summary>
    internal abstract ElementType MultiDimType { get; }

    /// <summary>The qualified name that goes with these types; empty for numbers.</summary>
    internal abstract ReadOnlySpan<byte> TypeName { get; }

    /// <summary>Whether any bytes are items, so that nothing but their number can be wrong.</summary>
    internal virtual bool ArePacked => false;

    /// <summary>Bytes that an item counts for against the limit of a memory's request.</summary>
    internal abstract uint TransferSize { get; }

    /// <summary>Of `T[n]`.</summary>
    public ValueCodec<T[]> FixedArray(int length) => new ArrayCodec<T>(this, length, length);

    /// <summary>Of `T[n-]`.</summary>
    public ValueCodec<T[]> MaximumArray(int length) => new ArrayCodec<T>(this, 0, length);

    /// <summary>Of `T[a,b]`.</summary>
    public ValueCodec<MultiDimArray<T>> FixedMultiDim(params int[] dims) => new MultiDimCodec<T>(this, dims);

    /// <summary>Of a field `T[a,b]` of a pod, where only the items travel (03, section 9).</summary>
    public ValueCodec<MultiDimArray<T>> FlatMultiDim(params int[] dims) => new FlatMultiDimCodec<T>(this, dims);

    /// <inheritdoc/>
    public override void Write(ElementWriter writer, scoped in ElementKey key, T value) =>
        WriteItems(writer, key, new ReadOnlySpan<T>(in value));

    /// <summary>Puts an array in front of what the writer holds.</summary>
    public abstract void WriteItems(ElementWriter writer, scoped in ElementKey key, scoped ReadOnlySpan<T> items);

    /// <summary>The same for a whole array, which may stay where it is.</summary>
    internal virtual void WriteArray(ElementWriter writer, scoped in ElementKey key, T[] items) => WriteItems(writer, key, items);

    /// <summary>How many items an element holds. Throws when it holds none of this type.</summary>
    public abstract int CountItems(scoped in Element element);

    /// <summary>Reads the items of an element into a place that has exactly their number.</summary>
    public abstract void ReadItems(scoped in Element element, Span<T> items);

    /// <summary>The items of an element.</summary>
    public T[] ReadItems(scoped in Element element)
    {
        int count = CountItems(element);
        if (count == 0)
        {
            return [];
        }
        T[] items = GC.AllocateUninitializedArray<T>(count);
        ReadItems(element, items);
        return items;
    }
}
