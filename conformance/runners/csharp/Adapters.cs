// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Concurrent;
using System.Collections.Generic;
using System.Text.Json.Nodes;
using Robdef.Runtime;

namespace Robdef.Conformance;

/// <summary>Implemented by the code that is generated for each definition.</summary>
internal interface IAddAdapters
{
    void AddTo(Adapters adapters);
}

/// <summary>What the runner has for an object of a definition.</summary>
internal sealed record ObjectAdapter(Func<Stub, Caller> Call, Func<Script, Skeleton> Serve);

/// <summary>All types and objects that a folder of captures knows, by their names.</summary>
internal sealed class Adapters
{
    private readonly ConcurrentDictionary<string, Adapter> _byName = new(StringComparer.Ordinal);
    private readonly Dictionary<Type, Adapter> _byType = [];
    private readonly Dictionary<string, ObjectAdapter> _objects = new(StringComparer.Ordinal);
    private readonly List<ServiceDefinition> _definitions = [];

    public Adapters()
    {
        Numbers.AddTo(this);
        Add(new TextAdapter());
        var varValue = new VarValueAdapter(this);
        Add(varValue);
        Add(varValue.Container("list"));
        Add(varValue.Container("int32"));
        Add(varValue.Container("string"));
    }

    public IReadOnlyList<ServiceDefinition> Definitions => _definitions;

    public TypeRegistry Types => new(AllRecords());

    public void Add(ServiceDefinition definition) => _definitions.Add(definition);

    public void Add(string name, ObjectAdapter adapter) => _objects.Add(name, adapter);

    public void Add(Adapter adapter)
    {
        _byName.TryAdd(adapter.Name, adapter);
        _byType.TryAdd(adapter.Type, adapter);
    }

    /// <summary>Adds a type that may be in arrays, with these.</summary>
    public void AddItem(Adapter adapter)
    {
        Add(adapter);
        Add(adapter.Array(""));
        Add(adapter.Array("*"));
    }

    public ObjectAdapter Object(string name) => _objects.TryGetValue(name, out ObjectAdapter? adapter)
        ? adapter
        : throw new KeyNotFoundException($"unknown object type {name}");

    /// <summary>That of a number, or of what a varvalue holds.</summary>
    public Adapter Of(Type type) => _byType.TryGetValue(type, out Adapter? adapter)
        ? adapter
        : throw new KeyNotFoundException($"a varvalue holds a {type}");

    public Adapter<T> OfNumber<T>() => (Adapter<T>)Of(typeof(T));

    public Adapter<T> Of<T>(string name) => (Adapter<T>)Of(name);

    /// <summary>The adapter of a type as definitions spell it.</summary>
    public Adapter Of(string name) => _byName.GetOrAdd(name, static (text, adapters) => adapters.Make(text), this);

    public JsonNode? Write<T>(string type, T value) => Of<T>(type).Write(value);

    public T Read<T>(string type, JsonNode? json) => Of<T>(type).Read(json);

    public VarValue? ReadVarValue(JsonNode? json) => Read<VarValue?>("varvalue", json);

    public Dictionary<string, VarValue?> ReadVarValues(JsonNode? json)
    {
        var values = new Dictionary<string, VarValue?>(StringComparer.Ordinal);
        foreach ((string name, JsonNode? value) in json as JsonObject ?? [])
        {
            values[name] = ReadVarValue(value);
        }
        return values;
    }

    private Adapter Make(string name)
    {
        int brace = name.LastIndexOf('{');
        if (brace >= 0)
        {
            string form = name[(brace + 1)..^1];
            return form == "generator" ? Of(name[..brace]) : Of(name[..brace]).Container(form);
        }
        int bracket = name.LastIndexOf('[');
        return bracket >= 0
            ? Of(name[..bracket]).Array(name[(bracket + 1)..^1])
            : throw new KeyNotFoundException($"unknown type {name}");
    }

    private IEnumerable<IRecordCodec> AllRecords()
    {
        foreach (ServiceDefinition definition in _definitions)
        {
            foreach (IRecordCodec codec in definition.Records)
            {
                yield return codec;
            }
        }
    }
}
