// SPDX-License-Identifier: Apache-2.0
using System;
using System.Linq;
using System.Numerics;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Text.Json.Nodes;
using Robdef.Runtime;

namespace Robdef.Conformance;

internal sealed class NumberAdapter<T>(string name, ItemCodec<T> codec, Func<JsonNode, T> read, Func<T, JsonNode> write) : ItemAdapter<T>(name, codec)
{
    public override T Read(JsonNode? json) => read(json ?? throw new FormatException("null where a number is due"));

    public override JsonNode Write(T value) => write(value);
}

internal sealed class TextAdapter() : Adapter<string>("string", ValueCodec.String)
{
    public override string Read(JsonNode? json) => json!.GetValue<string>();

    public override JsonNode Write(string value) => JsonValue.Create(value);
}

internal sealed class EnumAdapter<T>(string name) : Adapter<T>(name, ValueCodec.Enum<T>())
    where T : unmanaged, Enum
{
    public override T Read(JsonNode? json)
    {
        int number = json!.GetValue<int>();
        return Unsafe.As<int, T>(ref number);
    }

    public override JsonNode Write(T value) => Unsafe.As<T, int>(ref value);
}

/// <summary>{type, value}, or null.</summary>
internal sealed class VarValueAdapter(Adapters adapters) : Adapter<VarValue?>("varvalue", ValueCodec.VarValue)
{
    public override VarValue? Read(JsonNode? json) => json?["value"] is { } value
        ? adapters.Of(json["type"]!.GetValue<string>()).MakeVarValue(value)
        : null;

    public override JsonNode? Write(VarValue? value)
    {
        if (value is null)
        {
            return null;
        }
        Adapter adapter = adapters.Of(value.Value.GetType());
        return new JsonObject { ["type"] = adapter.Name, ["value"] = adapter.WriteAny(value.Value) };
    }

    public override VarValue MakeVarValue(JsonNode? json) => throw new InvalidOperationException("a varvalue in a varvalue");
}

/// <summary>A struct: the fields by their names.</summary>
internal sealed class StructAdapter<T>(StructCodec<T> codec, Func<JsonNode, T> read, Func<T, JsonObject> write) : Adapter<T?>(codec.QualifiedName, codec)
    where T : class
{
    public override T? Read(JsonNode? json) => json is null ? null : read(json);

    public override JsonNode? Write(T? value) => value is null ? null : write(value);
}

internal sealed class PodAdapter<T>(PodCodec<T> codec, Func<JsonNode, T> read, Func<T, JsonObject> write) : ItemAdapter<T>(codec.QualifiedName, codec)
    where T : class
{
    public override T Read(JsonNode? json) => read(json!);

    public override JsonNode Write(T value) => write(value);
}

/// <summary>A namedarray: the flat list of its numbers.</summary>
internal sealed class NamedArrayAdapter<T, TNumber>(NamedArrayCodec<T, TNumber> codec, Adapter<TNumber> number) : ItemAdapter<T>(codec.QualifiedName, codec)
    where T : unmanaged
    where TNumber : unmanaged
{
    private readonly NamedArrayCodec<T, TNumber> _codec = codec;

    public override T Read(JsonNode? json)
    {
        TNumber[] numbers = [.. Json.Items(json).Select(number.Read)];
        return numbers.Length * Unsafe.SizeOf<TNumber>() == Unsafe.SizeOf<T>()
            ? MemoryMarshal.Cast<TNumber, T>(numbers)[0]
            : throw new RobdefException(ErrorCode.DataTypeError, "another count of numbers");
    }

    public override JsonNode Write(T value) => new JsonArray([.. _codec.Numbers(in value).ToArray().Select(number.Write)]);
}

/// <summary>Numbers of the captures.</summary>
internal static class Numbers
{
    public static void AddTo(Adapters adapters)
    {
        adapters.AddItem(new NumberAdapter<double>("double", ValueCodec.Double, Json.ToDouble, Json.Of));
        adapters.AddItem(new NumberAdapter<float>("single", ValueCodec.Single, Json.ToSingle, Json.Of));
        adapters.AddItem(new NumberAdapter<sbyte>("int8", ValueCodec.Int8, Json.To<sbyte>, value => value));
        adapters.AddItem(new NumberAdapter<byte>("uint8", ValueCodec.UInt8, Json.To<byte>, value => value));
        adapters.AddItem(new NumberAdapter<short>("int16", ValueCodec.Int16, Json.To<short>, value => value));
        adapters.AddItem(new NumberAdapter<ushort>("uint16", ValueCodec.UInt16, Json.To<ushort>, value => value));
        adapters.AddItem(new NumberAdapter<int>("int32", ValueCodec.Int32, Json.To<int>, value => value));
        adapters.AddItem(new NumberAdapter<uint>("uint32", ValueCodec.UInt32, Json.To<uint>, value => value));
        adapters.AddItem(new NumberAdapter<long>("int64", ValueCodec.Int64, Json.To<long>, value => Json.Text(value)));
        adapters.AddItem(new NumberAdapter<ulong>("uint64", ValueCodec.UInt64, Json.To<ulong>, value => Json.Text(value)));
        adapters.AddItem(new NumberAdapter<Complex>("cdouble", ValueCodec.ComplexDouble,
            json => new Complex(Json.ToDouble(json[0]!), Json.ToDouble(json[1]!)),
            value => new JsonArray(Json.Of(value.Real), Json.Of(value.Imaginary))));
        adapters.AddItem(new NumberAdapter<ComplexSingle>("csingle", ValueCodec.ComplexSingle,
            json => new ComplexSingle(Json.ToSingle(json[0]!), Json.ToSingle(json[1]!)),
            value => new JsonArray(Json.Of(value.Real), Json.Of(value.Imaginary))));
        adapters.AddItem(new NumberAdapter<bool>("bool", ValueCodec.Bool, json => json.GetValue<bool>(), value => value));
    }
}
