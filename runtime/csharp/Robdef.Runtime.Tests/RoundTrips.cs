// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using Conformance.Types;

namespace Robdef.Runtime.Tests;

/// <summary>The codec of a type that is known by its text only.</summary>
internal interface IRoundTrip
{
    object? Read(Element element);

    void Write(ElementWriter writer, scoped in ElementKey key, object? value);

    IRoundTrip Container(string form);

    IRoundTrip Array(string form);
}

internal class RoundTrip<T>(ValueCodec<T> codec) : IRoundTrip
{
    public object? Read(Element element) => codec.Read(element);

    public void Write(ElementWriter writer, scoped in ElementKey key, object? value) => codec.Write(writer, key, (T)value!);

    public IRoundTrip Container(string form) => form switch
    {
        "list" => new RoundTrip<List<T>?>(ValueCodec.List(codec)),
        "int32" => new RoundTrip<Dictionary<int, T>?>(ValueCodec.Int32Map(codec)),
        "string" => new RoundTrip<Dictionary<string, T>?>(ValueCodec.StringMap(codec)),
        _ => throw new ArgumentException(form),
    };

    public virtual IRoundTrip Array(string form) => throw new ArgumentException(form);
}

internal sealed class ItemRoundTrip<T>(ItemCodec<T> codec) : RoundTrip<T>(codec)
{
    private readonly ItemCodec<T> _codec = codec;

    public override IRoundTrip Array(string form)
    {
        if (form.Length == 0)
        {
            return new RoundTrip<T[]>(_codec.Array);
        }
        if (form == "*")
        {
            return new RoundTrip<MultiDimArray<T>>(_codec.MultiDim);
        }
        int[] dims = [.. form.TrimEnd('-').Split(',').Select(text => int.Parse(text, CultureInfo.InvariantCulture))];
        if (dims.Length > 1)
        {
            return new RoundTrip<MultiDimArray<T>>(_codec.FixedMultiDim(dims));
        }
        return new RoundTrip<T[]>(form.EndsWith('-') ? _codec.MaximumArray(dims[0]) : _codec.FixedArray(dims[0]));
    }
}

internal static class RoundTrips
{
    public static IRoundTrip Of(string type)
    {
        int brace = type.IndexOf('{', StringComparison.Ordinal);
        if (brace >= 0)
        {
            return Of(type[..brace]).Container(type[(brace + 1)..^1]);
        }
        int bracket = type.IndexOf('[', StringComparison.Ordinal);
        return bracket >= 0 ? Base(type[..bracket]).Array(type[(bracket + 1)..^1]) : Base(type);
    }

    private static IRoundTrip Base(string type) => type switch
    {
        "double" => new ItemRoundTrip<double>(ValueCodec.Double),
        "single" => new ItemRoundTrip<float>(ValueCodec.Single),
        "int8" => new ItemRoundTrip<sbyte>(ValueCodec.Int8),
        "uint8" => new ItemRoundTrip<byte>(ValueCodec.UInt8),
        "int16" => new ItemRoundTrip<short>(ValueCodec.Int16),
        "uint16" => new ItemRoundTrip<ushort>(ValueCodec.UInt16),
        "int32" => new ItemRoundTrip<int>(ValueCodec.Int32),
        "uint32" => new ItemRoundTrip<uint>(ValueCodec.UInt32),
        "int64" => new ItemRoundTrip<long>(ValueCodec.Int64),
        "uint64" => new ItemRoundTrip<ulong>(ValueCodec.UInt64),
        "bool" => new ItemRoundTrip<bool>(ValueCodec.Bool),
        "cdouble" => new ItemRoundTrip<System.Numerics.Complex>(ValueCodec.ComplexDouble),
        "csingle" => new ItemRoundTrip<ComplexSingle>(ValueCodec.ComplexSingle),
        "string" => new RoundTrip<string>(ValueCodec.String),
        "varvalue" or "void" => new RoundTrip<VarValue?>(ValueCodec.VarValue),
        "conformance.types.Mode" => new RoundTrip<Mode>(ValueCodec.Enum<Mode>()),
        "conformance.types.Counter" => new ItemRoundTrip<Counter>(Counter.RrCodec),
        "conformance.types.Sample" => new ItemRoundTrip<Sample>(Sample.RrCodec),
        "conformance.types.Reading" => new ItemRoundTrip<Reading>(Reading.RrCodec),
        "conformance.types.Knots" => new ItemRoundTrip<Knots>(Knots.RrCodec),
        "conformance.types.Pixel" => new ItemRoundTrip<Pixel>(Pixel.RrCodec),
        "conformance.types.Ticks" => new ItemRoundTrip<Ticks>(Ticks.RrCodec),
        "conformance.types.Transform" => new ItemRoundTrip<Transform>(Transform.RrCodec),
        "conformance.types.Twist" => new ItemRoundTrip<Twist>(Twist.RrCodec),
        "conformance.types.Vector3" => new ItemRoundTrip<Vector3>(Vector3.RrCodec),
        "conformance.types.Everything" => new RoundTrip<Everything?>(Everything.RrCodec),
        "conformance.types.Leaf" => new RoundTrip<Leaf?>(Leaf.RrCodec),
        "conformance.types.Stats" => new RoundTrip<Stats?>(Stats.RrCodec),
        "conformance.types.Tree" => new RoundTrip<Tree?>(Tree.RrCodec),
        _ => throw new ArgumentException(type),
    };
}
