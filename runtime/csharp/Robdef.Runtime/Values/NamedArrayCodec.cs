// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Text;

namespace Robdef.Runtime;

/// <summary>
/// The codec of a namedarray: numbers that lie in memory as they travel, so that arrays of them are
/// one block.
/// </summary>
/// <typeparam name="T">The struct; its fields are numbers of one type and nothing else, in order.</typeparam>
/// <typeparam name="TNumber">The number.</typeparam>
public sealed class NamedArrayCodec<T, TNumber> : ItemCodec<T>, IRecordCodec
    where T : unmanaged
    where TNumber : unmanaged
{
    private readonly byte[] _name;
    private readonly ItemCodec<TNumber> _number;

    /// <summary>A codec.</summary>
    /// <param name="qualifiedName">`example.geometry.Vector3`</param>
    /// <param name="number">The codec of its numbers.</param>
    public NamedArrayCodec(string qualifiedName, ItemCodec<TNumber> number)
    {
        QualifiedName = qualifiedName;
        _name = Encoding.UTF8.GetBytes(qualifiedName);
        _number = number;
    }

    /// <inheritdoc/>
    public string QualifiedName { get; }

    internal override ElementType ArrayType => ElementType.NamedArray;

    internal override ElementType MultiDimType => ElementType.NamedMultiDimArray;

    internal override ReadOnlySpan<byte> TypeName => _name;

    internal override bool ArePacked => true;

    internal override uint TransferSize => (uint)Unsafe.SizeOf<TNumber>();

    private static int NumbersPerItem => Unsafe.SizeOf<T>() / Unsafe.SizeOf<TNumber>();

    /// <inheritdoc/>
    public override void WriteItems(ElementWriter writer, scoped in ElementKey key, scoped ReadOnlySpan<T> items)
    {
        int begin = writer.BeginElement();
        int array = writer.BeginElement();
        Packed.Write(writer, items);
        writer.EndElement(array, "array"u8, _number.ArrayType, default, checked(items.Length * NumbersPerItem));
        writer.EndElement(begin, key, ElementType.NamedArray, _name, 1);
    }

    internal override void WriteArray(ElementWriter writer, scoped in ElementKey key, T[] items)
    {
        int begin = writer.BeginElement();
        writer.PrependArray("array"u8, _number.ArrayType, items, checked(items.Length * NumbersPerItem));
        writer.EndElement(begin, key, ElementType.NamedArray, _name, 1);
    }

    /// <inheritdoc/>
    public override T Read(scoped in Element element)
    {
        int count = CountItems(element);
        if (count != 1)
        {
            throw element.Error(ErrorCode.DataTypeError, $"holds {count} namedarrays where one is due");
        }
        Unsafe.SkipInit(out T item);
        ReadItems(element, new Span<T>(ref item));
        return item;
    }

    /// <inheritdoc/>
    public override int CountItems(scoped in Element element)
    {
        element.Expect(ElementType.NamedArray);
        element.ExpectTypeName(_name);
        int numbers = _number.CountItems(element.Find("array"u8));
        return numbers % NumbersPerItem == 0
            ? numbers / NumbersPerItem
            : throw element.Error(ErrorCode.DataTypeError, $"has {numbers} numbers, which is no multiple of {NumbersPerItem}");
    }

    /// <inheritdoc/>
    public override void ReadItems(scoped in Element element, Span<T> items) =>
        _number.ReadItems(element.Find("array"u8), MemoryMarshal.Cast<T, TNumber>(items));

    /// <summary>Whether all numbers are equal.</summary>
    public bool AreEqual(in T a, in T b) => Numbers(in a).SequenceEqual(Numbers(in b));

    /// <summary>A hash of all numbers.</summary>
    public int HashOf(in T value)
    {
        var hash = default(HashCode);
        foreach (TNumber number in Numbers(in value))
        {
            hash.Add(number);
        }
        return hash.ToHashCode();
    }

    /// <summary>All numbers of an item, in their order: the same memory.</summary>
    public ReadOnlySpan<TNumber> Numbers(ref readonly T value) =>
        MemoryMarshal.Cast<T, TNumber>(new ReadOnlySpan<T>(in value));

    VarValue IRecordCodec.ReadVarying(scoped in Element element) => element.Type == ElementType.NamedMultiDimArray
        ? new VarValue(MultiDim.Read(element), MultiDim)
        : new VarValue(Array.Read(element), Array);
}
