// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Numerics;

namespace Robdef.Runtime;

/// <summary>
/// Turns values of one type of a definition into message elements and back. Codecs hold no state:
/// any number of threads may use one at once.
/// </summary>
/// <typeparam name="T">The type in C#.</typeparam>
public abstract class ValueCodec<T> : IValueCodec
{
    /// <summary>Puts the value in front of what the writer holds.</summary>
    /// <exception cref="RobdefException">The value is null or of a length that its type does not allow.</exception>
    public abstract void Write(ElementWriter writer, scoped in ElementKey key, T value);

    /// <summary>The value of an element.</summary>
    /// <exception cref="RobdefException">The element does not hold such a value.</exception>
    public abstract T Read(scoped in Element element);

    /// <summary>Throws what <see cref="Read"/> does, and reads no more than that takes.</summary>
    internal virtual void Check(scoped in Element element) => Read(element);

    void IValueCodec.Write(ElementWriter writer, scoped in ElementKey key, object value) => Write(writer, key, (T)value);
}

/// <summary>A codec whose type is not known at compile time.</summary>
internal interface IValueCodec
{
    void Write(ElementWriter writer, scoped in ElementKey key, object value);
}

/// <summary>The codecs of the language's own types. Those of structs, pods and namedarrays are made with them.</summary>
public static class ValueCodec
{
    /// <summary>Of `double`.</summary>
    public static ItemCodec<double> Double { get; } = new NumberCodec<double>(ElementType.Double);

    /// <summary>Of `single`.</summary>
    public static ItemCodec<float> Single { get; } = new NumberCodec<float>(ElementType.Single);

    /// <summary>Of `int8`.</summary>
    public static ItemCodec<sbyte> Int8 { get; } = new NumberCodec<sbyte>(ElementType.Int8);

    /// <summary>Of `uint8`.</summary>
    public static ItemCodec<byte> UInt8 { get; } = new NumberCodec<byte>(ElementType.UInt8);

    /// <summary>Of `int16`.</summary>
    public static ItemCodec<short> Int16 { get; } = new NumberCodec<short>(ElementType.Int16);

    /// <summary>Of `uint16`.</summary>
    public static ItemCodec<ushort> UInt16 { get; } = new NumberCodec<ushort>(ElementType.UInt16);

    /// <summary>Of `int32`.</summary>
    public static ItemCodec<int> Int32 { get; } = new NumberCodec<int>(ElementType.Int32);

    /// <summary>Of `uint32`.</summary>
    public static ItemCodec<uint> UInt32 { get; } = new NumberCodec<uint>(ElementType.UInt32);

    /// <summary>Of `int64`.</summary>
    public static ItemCodec<long> Int64 { get; } = new NumberCodec<long>(ElementType.Int64);

    /// <summary>Of `uint64`.</summary>
    public static ItemCodec<ulong> UInt64 { get; } = new NumberCodec<ulong>(ElementType.UInt64);

    /// <summary>Of `cdouble`.</summary>
    public static ItemCodec<Complex> ComplexDouble { get; } = new NumberCodec<Complex>(ElementType.ComplexDouble);

    /// <summary>Of `csingle`.</summary>
    public static ItemCodec<ComplexSingle> ComplexSingle { get; } = new NumberCodec<ComplexSingle>(ElementType.ComplexSingle);

    /// <summary>Of `bool`.</summary>
    public static ItemCodec<bool> Bool { get; } = new NumberCodec<bool>(ElementType.Bool);

    /// <summary>Of `string`.</summary>
    public static ValueCodec<string> String { get; } = new StringCodec();

    /// <summary>Of `varvalue`.</summary>
    public static ValueCodec<VarValue?> VarValue { get; } = new VarValueCodec();

    /// <summary>Of an enum: its number, whether the enum knows it or not.</summary>
    public static ValueCodec<T> Enum<T>()
        where T : unmanaged, Enum => EnumCodec<T>.Instance;

    /// <summary>Of `T{list}`.</summary>
    public static ValueCodec<List<T>?> List<T>(ValueCodec<T> item) => new ListCodec<T>(item);

    /// <summary>Of `T{int32}`.</summary>
    public static ValueCodec<Dictionary<int, T>?> Int32Map<T>(ValueCodec<T> item) => new Int32MapCodec<T>(item);

    /// <summary>Of `T{string}`.</summary>
    public static ValueCodec<Dictionary<string, T>?> StringMap<T>(ValueCodec<T> item) => new StringMapCodec<T>(item);
}
