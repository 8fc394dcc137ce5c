// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;

namespace Robdef.Runtime;

/// <summary>
/// Any value of the protocol; null stands for itself. A received one holds what the bytes tell:
/// numbers always as an array, even a single one; a struct as its record; pods and namedarrays as
/// arrays; containers as lists and maps of varvalues; text as a string.
/// </summary>
public sealed class VarValue
{
    private readonly IValueCodec _codec;

    internal VarValue(object value, IValueCodec codec)
    {
        Value = value;
        _codec = codec;
    }

    /// <summary>The value itself.</summary>
    public object Value { get; }

    /// <summary>Holds a value of any type that has a codec: `VarValue.Of(pose, Pose.RrCodec)`.</summary>
    public static VarValue Of<T>(T value, ValueCodec<T> codec)
    {
        ArgumentNullException.ThrowIfNull(value);
        ArgumentNullException.ThrowIfNull(codec);
        return new VarValue(value, codec);
    }

    /// <summary>The value as a <typeparamref name="T"/>.</summary>
    /// <exception cref="RobdefException">DataTypeMismatch when it is none.</exception>
    public T Get<T>() => Value is T value
        ? value
        : throw new DataTypeMismatchException($"a varvalue holds a {Value.GetType().Name}");

    /// <summary>One number: of a scalar, or of an array of one, which is what a received scalar is.</summary>
    /// <exception cref="RobdefException">DataTypeMismatch when it is neither.</exception>
    public T Number<T>()
        where T : unmanaged => Value switch
        {
            T number => number,
            T[] { Length: 1 } array => array[0],
            _ => throw new DataTypeMismatchException($"a varvalue holds a {Value.GetType().Name}"),
        };

#pragma warning disable CA2225 // The constructor of these values is VarValue.Of.
    /// <summary>Text.</summary>
    public static implicit operator VarValue(string value) => Of(value, ValueCodec.String);

    /// <summary>A number.</summary>
    public static implicit operator VarValue(double value) => Of(value, ValueCodec.Double);

    /// <summary>A number.</summary>
    public static implicit operator VarValue(int value) => Of(value, ValueCodec.Int32);

    /// <summary>A truth.</summary>
    public static implicit operator VarValue(bool value) => Of(value, ValueCodec.Bool);

    /// <summary>Numbers.</summary>
    public static implicit operator VarValue(double[] value) => Of(value, ValueCodec.Double.Array);

    /// <summary>Numbers.</summary>
    public static implicit operator VarValue(int[] value) => Of(value, ValueCodec.Int32.Array);

    /// <summary>Bytes.</summary>
    public static implicit operator VarValue(byte[] value) => Of(value, ValueCodec.UInt8.Array);

    /// <summary>A list of any values.</summary>
    public static implicit operator VarValue(List<VarValue?> value) => Of(value, VarValueCodec.List!);

    /// <summary>A map of any values.</summary>
    public static implicit operator VarValue(Dictionary<int, VarValue?> value) => Of(value, VarValueCodec.Int32Map!);

    /// <summary>A map of any values.</summary>
    public static implicit operator VarValue(Dictionary<string, VarValue?> value) => Of(value, VarValueCodec.StringMap!);
#pragma warning restore CA2225

    internal void Write(ElementWriter writer, scoped in ElementKey key) => _codec.Write(writer, key, Value);
}

/// <summary>A varvalue adds nothing to what it holds: the element says what it is.</summary>
internal sealed class VarValueCodec : ValueCodec<VarValue?>
{
    public static ValueCodec<List<VarValue?>?> List => Containers.List;

    public static ValueCodec<Dictionary<int, VarValue?>?> Int32Map => Containers.Int32Map;

    public static ValueCodec<Dictionary<string, VarValue?>?> StringMap => Containers.StringMap;

    public override void Write(ElementWriter writer, scoped in ElementKey key, VarValue? value)
    {
        if (value is null)
        {
            NullValue.Write(writer, key);
            return;
        }
        value.Write(writer, key);
    }

    public override VarValue? Read(scoped in Element element) => element.Type switch
    {
        ElementType.Void => null,
        ElementType.Double => Numbers(ValueCodec.Double, element),
        ElementType.Single => Numbers(ValueCodec.Single, element),
        ElementType.Int8 => Numbers(ValueCodec.Int8, element),
        ElementType.UInt8 => Numbers(ValueCodec.UInt8, element),
        ElementType.Int16 => Numbers(ValueCodec.Int16, element),
        ElementType.UInt16 => Numbers(ValueCodec.UInt16, element),
        ElementType.Int32 => Numbers(ValueCodec.Int32, element),
        ElementType.UInt32 => Numbers(ValueCodec.UInt32, element),
        ElementType.Int64 => Numbers(ValueCodec.Int64, element),
        ElementType.UInt64 => Numbers(ValueCodec.UInt64, element),
        ElementType.ComplexDouble => Numbers(ValueCodec.ComplexDouble, element),
        ElementType.ComplexSingle => Numbers(ValueCodec.ComplexSingle, element),
        ElementType.Bool => Numbers(ValueCodec.Bool, element),
        ElementType.String => new VarValue(ValueCodec.String.Read(element), (IValueCodec)ValueCodec.String),
        ElementType.List => new VarValue(List.Read(element)!, List),
        ElementType.Int32Map => new VarValue(Int32Map.Read(element)!, Int32Map),
        ElementType.StringMap => new VarValue(StringMap.Read(element)!, StringMap),
        ElementType.MultiDimArray => MultiDimNumbers(element),
        ElementType.Structure or ElementType.PodArray or ElementType.PodMultiDimArray or ElementType.NamedArray
            or ElementType.NamedMultiDimArray => element.Registry.Find(element).ReadVarying(element),
        _ => throw element.Error(ErrorCode.DataTypeError, $"of type {element.Type} is no varvalue"),
    };

    private static VarValue Numbers<T>(ItemCodec<T> item, scoped in Element element) =>
        new(item.Array.Read(element), item.Array);

    private static VarValue MultiDimNumbers(scoped in Element element) => element.Find("array"u8).Type switch
    {
        ElementType.Double => MultiDim(ValueCodec.Double, element),
        ElementType.Single => MultiDim(ValueCodec.Single, element),
        ElementType.Int8 => MultiDim(ValueCodec.Int8, element),
        ElementType.UInt8 => MultiDim(ValueCodec.UInt8, element),
        ElementType.Int16 => MultiDim(ValueCodec.Int16, element),
        ElementType.UInt16 => MultiDim(ValueCodec.UInt16, element),
        ElementType.Int32 => MultiDim(ValueCodec.Int32, element),
        ElementType.UInt32 => MultiDim(ValueCodec.UInt32, element),
        ElementType.Int64 => MultiDim(ValueCodec.Int64, element),
        ElementType.UInt64 => MultiDim(ValueCodec.UInt64, element),
        ElementType.ComplexDouble => MultiDim(ValueCodec.ComplexDouble, element),
        ElementType.ComplexSingle => MultiDim(ValueCodec.ComplexSingle, element),
        ElementType.Bool => MultiDim(ValueCodec.Bool, element),
        _ => throw element.Error(ErrorCode.DataTypeError, "is a multidimensional array of no numbers"),
    };

    private static VarValue MultiDim<T>(ItemCodec<T> item, scoped in Element element) =>
        new(item.MultiDim.Read(element), item.MultiDim);

    /// <summary>Made at first use: they hold the codec whose class is being made.</summary>
    private static class Containers
    {
        public static readonly ValueCodec<List<VarValue?>?> List = ValueCodec.List(ValueCodec.VarValue);
        public static readonly ValueCodec<Dictionary<int, VarValue?>?> Int32Map = ValueCodec.Int32Map(ValueCodec.VarValue);
        public static readonly ValueCodec<Dictionary<string, VarValue?>?> StringMap = ValueCodec.StringMap(ValueCodec.VarValue);
    }
}
