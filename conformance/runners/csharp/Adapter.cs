// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using System.Text.Json.Nodes;
using Robdef.Runtime;

namespace Robdef.Conformance;

/// <summary>Values of one type between C#, the notation of the captures, and elements.</summary>
internal abstract class Adapter(string name)
{
    /// <summary>As definitions spell the type, with qualified names.</summary>
    public string Name => name;

    /// <summary>The type in C#.</summary>
    public abstract Type Type { get; }

    public abstract JsonNode? WriteAny(object value);

    public abstract VarValue MakeVarValue(JsonNode? json);

    public abstract JsonNode? Unpack(Element element);

    public abstract void Pack(ElementWriter writer, scoped in ElementKey key, JsonNode? json);

    /// <summary>That of `T{list}`, `T{int32}` or `T{string}`.</summary>
    public abstract Adapter Container(string form);

    /// <summary>That of `T[...]`. Only of items.</summary>
    public virtual Adapter Array(string form) => throw new InvalidOperationException($"there are no arrays of {Name}");
}

internal abstract class Adapter<T>(string name, ValueCodec<T> codec) : Adapter(name)
{
    public override Type Type => typeof(T);

    public abstract T Read(JsonNode? json);

    public abstract JsonNode? Write(T value);

    public override JsonNode? WriteAny(object value) => Write((T)value);

    public override VarValue MakeVarValue(JsonNode? json) => VarValue.Of(Read(json), codec);

    public override JsonNode? Unpack(Element element) => Write(codec.Read(element));

    public override void Pack(ElementWriter writer, scoped in ElementKey key, JsonNode? json) => codec.Write(writer, key, Read(json));

    public override Adapter Container(string form) => form switch
    {
        "list" => new ListAdapter<T>(this, ValueCodec.List(codec)),
        "int32" => new Int32MapAdapter<T>(this, ValueCodec.Int32Map(codec)),
        "string" => new StringMapAdapter<T>(this, ValueCodec.StringMap(codec)),
        _ => throw new InvalidOperationException($"there is no container {form}"),
    };
}

/// <summary>A type that may stand in arrays.</summary>
internal abstract class ItemAdapter<T>(string name, ItemCodec<T> codec) : Adapter<T>(name, codec)
{
    private readonly ItemCodec<T> _codec = codec;

    public override Adapter Array(string form)
    {
        string array = $"{Name}[{form}]";
        if (form.Length == 0)
        {
            return new ArrayAdapter<T>(array, this, _codec.Array);
        }
        if (form == "*")
        {
            return new MultiDimAdapter<T>(array, this, _codec.MultiDim);
        }
        int[] dims = [.. form.TrimEnd('-').Split(',').Select(text => int.Parse(text, CultureInfo.InvariantCulture))];
        if (dims.Length > 1)
        {
            return new MultiDimAdapter<T>(array, this, _codec.FixedMultiDim(dims));
        }
        return new ArrayAdapter<T>(array, this, form.EndsWith('-') ? _codec.MaximumArray(dims[0]) : _codec.FixedArray(dims[0]));
    }
}

internal sealed class ArrayAdapter<T>(string name, Adapter<T> item, ValueCodec<T[]> codec) : Adapter<T[]>(name, codec)
{
    public override T[] Read(JsonNode? json) => [.. Json.Items(json).Select(item.Read)];

    public override JsonNode Write(T[] value) => new JsonArray([.. value.Select(item.Write)]);
}

internal sealed class MultiDimAdapter<T>(string name, Adapter<T> item, ValueCodec<MultiDimArray<T>> codec) : Adapter<MultiDimArray<T>>(name, codec)
{
    public override MultiDimArray<T> Read(JsonNode? json)
    {
        int[] dims = [.. Json.Items(json!["dims"]).Select(dim => dim!.GetValue<int>())];
        T[] items = [.. Json.Items(json["array"]).Select(item.Read)];
        try
        {
            return new MultiDimArray<T>(dims, items);
        }
        catch (ArgumentException refused)
        {
            throw new RobdefException(ErrorCode.DataTypeError, refused.Message);
        }
    }

    public override JsonNode Write(MultiDimArray<T> value) => new JsonObject
    {
        ["dims"] = new JsonArray([.. value.Dims.Select(dim => (JsonNode)dim)]),
        ["array"] = new JsonArray([.. value.Items.Select(item.Write)]),
    };
}

internal sealed class ListAdapter<T>(Adapter<T> item, ValueCodec<List<T>?> codec) : Adapter<List<T>?>(item.Name + "{list}", codec)
{
    public override List<T>? Read(JsonNode? json) => json is null ? null : [.. Json.Items(json).Select(item.Read)];

    public override JsonNode? Write(List<T>? value) => value is null ? null : new JsonArray([.. value.Select(item.Write)]);
}

internal sealed class Int32MapAdapter<T>(Adapter<T> item, ValueCodec<Dictionary<int, T>?> codec) : Adapter<Dictionary<int, T>?>(item.Name + "{int32}", codec)
{
    public override Dictionary<int, T>? Read(JsonNode? json)
    {
        if (json is null)
        {
            return null;
        }
        var map = new Dictionary<int, T>();
        foreach (JsonNode? pair in Json.Items(json))
        {
            map.TryAdd(pair![0]!.GetValue<int>(), item.Read(pair[1]));
        }
        return map;
    }

    public override JsonNode? Write(Dictionary<int, T>? value) => value is null
        ? null
        : new JsonArray([.. value.OrderBy(pair => pair.Key).Select(pair => new JsonArray(pair.Key, item.Write(pair.Value)))]);
}

internal sealed class StringMapAdapter<T>(Adapter<T> item, ValueCodec<Dictionary<string, T>?> codec)
    : Adapter<Dictionary<string, T>?>(item.Name + "{string}", codec)
{
    public override Dictionary<string, T>? Read(JsonNode? json)
    {
        if (json is null)
        {
            return null;
        }
        var map = new Dictionary<string, T>(StringComparer.Ordinal);
        foreach (JsonNode? pair in Json.Items(json))
        {
            map.TryAdd(pair![0]!.GetValue<string>(), item.Read(pair[1]));
        }
        return map;
    }

    public override JsonNode? Write(Dictionary<string, T>? value) => value is null
        ? null
        : new JsonArray([.. value.OrderBy(pair => pair.Key, StringComparer.Ordinal).Select(pair => new JsonArray(pair.Key, item.Write(pair.Value)))]);
}
