// SPDX-License-Identifier: Apache-2.0
using System;

namespace Robdef.Runtime;

/// <summary>
/// An array of several dimensions. Items lie column by column: the first index varies fastest, as
/// on the wire.
/// </summary>
/// <typeparam name="T">The item.</typeparam>
public sealed class MultiDimArray<T>
{
    /// <summary>An empty array of one dimension.</summary>
    public MultiDimArray()
    {
        Dims = [0];
        Items = [];
    }

    /// <summary>An array of default items.</summary>
    public MultiDimArray(params int[] dims)
        : this(dims, new T[MultiDim.Product(dims)])
    {
    }

    /// <summary>Takes dimensions and items as they are, without a copy.</summary>
    /// <exception cref="ArgumentException">The items are not as many as the product of the dimensions.</exception>
    public MultiDimArray(int[] dims, T[] items)
    {
        ArgumentNullException.ThrowIfNull(dims);
        ArgumentNullException.ThrowIfNull(items);
        if (MultiDim.Product(dims) != items.Length)
        {
            throw new ArgumentException($"{items.Length} items do not fill {string.Join(" x ", dims)}", nameof(items));
        }
        Dims = dims;
        Items = items;
    }

    /// <summary>The size in each dimension.</summary>
#pragma warning disable CA1819 // Both are what the array consists of, and are given away on purpose.
    public int[] Dims { get; }

    /// <summary>All items, the first index varying fastest.</summary>
    public T[] Items { get; }
#pragma warning restore CA1819

    /// <summary>The item at a place, indices counted from 0.</summary>
    public ref T this[params ReadOnlySpan<int> indices] => ref Items[MultiDim.Offset(Dims, indices)];
}

/// <summary>Places in arrays of several dimensions.</summary>
internal static class MultiDim
{
    /// <summary>0 for no dimensions: an empty array may travel without them (03, section 5).</summary>
    public static int Product(ReadOnlySpan<int> dims)
    {
        long product = dims.IsEmpty ? 0 : 1;
        foreach (int dim in dims)
        {
            if (dim < 0)
            {
                throw new ArgumentOutOfRangeException(nameof(dims), "a dimension is negative");
            }
            product *= dim;
            if (product > Array.MaxLength)
            {
                throw new ArgumentOutOfRangeException(nameof(dims), "the product of the dimensions is too large");
            }
        }
        return (int)product;
    }

    public static int Offset(ReadOnlySpan<int> dims, ReadOnlySpan<int> indices)
    {
        ArgumentOutOfRangeException.ThrowIfNotEqual(indices.Length, dims.Length);
        int offset = 0;
        for (int i = dims.Length - 1; i >= 0; --i)
        {
            ArgumentOutOfRangeException.ThrowIfNegative(indices[i]);
            ArgumentOutOfRangeException.ThrowIfGreaterThanOrEqual(indices[i], dims[i]);
            offset = (offset * dims[i]) + indices[i];
        }
        return offset;
    }
}
