// SPDX-License-Identifier: Apache-2.0
using System;

namespace Robdef.Runtime;

/// <summary>An array of one dimension, of any, a fixed or a maximum length.</summary>
internal sealed class ArrayCodec<T>(ItemCodec<T> item, int fewest, int most) : ValueCodec<T[]>
{
    public override void Write(ElementWriter writer, scoped in ElementKey key, T[] value)
    {
        if (value is null)
        {
            throw NullValue.Error(key);
        }
        if (value.Length < fewest || value.Length > most)
        {
            throw new DataTypeException($"an array of {value.Length} items is to be sent, and {Allowed}");
        }
        item.WriteArray(writer, key, value);
    }

    public override T[] Read(scoped in Element element)
    {
        CheckCount(element);
        return item.ReadItems(element);
    }

    internal override void Check(scoped in Element element)
    {
        CheckCount(element);
        if (!item.ArePacked)
        {
            item.ReadItems(element);
        }
    }

    private void CheckCount(scoped in Element element)
    {
        int count = item.CountItems(element);
        if (count < fewest || count > most)
        {
            throw element.Error(ErrorCode.DataTypeError, $"has {count} items, and {Allowed}");
        }
    }

    private string Allowed => fewest == most ? $"{most} are due" : $"{most} are allowed";
}

/// <summary>An array of several dimensions: `dims` and `array`.</summary>
internal sealed class MultiDimCodec<T>(ItemCodec<T> item, int[]? shape) : ValueCodec<MultiDimArray<T>>
{
    public override void Write(ElementWriter writer, scoped in ElementKey key, MultiDimArray<T> value)
    {
        if (value is null)
        {
            throw NullValue.Error(key);
        }
        if (shape is not null && !shape.AsSpan().SequenceEqual(value.Dims))
        {
            throw new DataTypeException(Shapes.Wrong(value.Dims, shape));
        }
        int begin = writer.BeginElement();
        item.WriteArray(writer, "array"u8, value.Items);
        WriteDims(writer, value.Dims);
        writer.EndElement(begin, key, item.MultiDimType, item.TypeName, 2);
    }

    public override MultiDimArray<T> Read(scoped in Element element)
    {
        element.Expect(item.MultiDimType);
        if (!item.TypeName.IsEmpty)
        {
            element.ExpectTypeName(item.TypeName);
        }
        int[] dims = ReadDims(element.Find("dims"u8));
        Element array = element.Find("array"u8);
        int count = item.CountItems(array);
        if (Shapes.Product(dims) != count)
        {
            throw element.Error(ErrorCode.DataTypeError, $"has {count} items for {string.Join(" x ", dims)}");
        }
        if (shape is not null && !shape.AsSpan().SequenceEqual(dims))
        {
            throw element.Error(ErrorCode.DataTypeError, Shapes.Wrong(dims, shape));
        }
        return new MultiDimArray<T>(dims, item.ReadItems(array));
    }

    private static void WriteDims(ElementWriter writer, ReadOnlySpan<int> dims)
    {
        Span<uint> numbers = dims.Length <= 16 ? stackalloc uint[dims.Length] : new uint[dims.Length];
        for (int i = 0; i < dims.Length; ++i)
        {
            numbers[i] = (uint)dims[i];
        }
        ValueCodec.UInt32.WriteItems(writer, "dims"u8, numbers);
    }

    private static int[] ReadDims(scoped in Element element)
    {
        uint[] numbers = ValueCodec.UInt32.ReadItems(element);
        int[] dims = new int[numbers.Length];
        for (int i = 0; i < dims.Length; ++i)
        {
            dims[i] = numbers[i] <= int.MaxValue
                ? (int)numbers[i]
                : throw element.Error(ErrorCode.DataTypeError, "has a dimension that is too large");
        }
        return dims;
    }
}

/// <summary>A field of a pod with several dimensions: its items only, the shape is known.</summary>
internal sealed class FlatMultiDimCodec<T>(ItemCodec<T> item, int[] shape) : ValueCodec<MultiDimArray<T>>
{
    private readonly int _count = MultiDim.Product(shape);

    public override void Write(ElementWriter writer, scoped in ElementKey key, MultiDimArray<T> value)
    {
        if (value is null)
        {
            throw NullValue.Error(key);
        }
        if (!shape.AsSpan().SequenceEqual(value.Dims))
        {
            throw new DataTypeException(Shapes.Wrong(value.Dims, shape));
        }
        item.WriteArray(writer, key, value.Items);
    }

    public override MultiDimArray<T> Read(scoped in Element element)
    {
        int count = item.CountItems(element);
        return count == _count
            ? new MultiDimArray<T>([.. shape], item.ReadItems(element))
            : throw element.Error(ErrorCode.DataTypeError, $"has {count} items, and {_count} are due");
    }
}

/// <summary>Dimensions as they arrive.</summary>
internal static class Shapes
{
    /// <summary>The product, or -1 when it is larger than an array can be.</summary>
    public static long Product(ReadOnlySpan<int> dims)
    {
        long product = dims.IsEmpty ? 0 : 1;
        foreach (int dim in dims)
        {
            product *= dim;
            if (product > Array.MaxLength)
            {
                return -1;
            }
        }
        return product;
    }

    public static string Wrong(int[] dims, int[] shape) =>
        $"has the dimensions {string.Join(" x ", dims)}, and {string.Join(" x ", shape)} are due";
}
