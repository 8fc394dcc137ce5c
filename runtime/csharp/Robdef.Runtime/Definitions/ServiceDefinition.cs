// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Frozen;
using System.Collections.Generic;
using System.Threading;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>An exception of a definition: its qualified name, and what makes one.</summary>
/// <param name="Name">`example.Fault`</param>
/// <param name="Create">From message, sub-name and parameter.</param>
public sealed record ExceptionType(string Name, Func<string, string, VarValue?, RobdefException> Create);

/// <summary>An object of a definition: its qualified name, and what makes its stub.</summary>
/// <param name="Name">`example.PanTilt`</param>
/// <param name="Create">From a handle.</param>
public sealed record StubFactory(string Name, Func<ObjectHandle, Stub> Create);

/// <summary>One service definition, as generated code describes it to the runtime.</summary>
public sealed class ServiceDefinition
{
    private readonly Lock _lock = new();
    private KnownTypes? _known;
    private DefinitionHandle? _handle;

    /// <summary>A definition.</summary>
    /// <param name="api">A constant of <see cref="StubApi"/>.</param>
    /// <param name="name">`example.mount`</param>
    /// <param name="text">Exactly as a service sends it.</param>
    public ServiceDefinition(int api, string name, string text)
    {
        ArgumentOutOfRangeException.ThrowIfNotEqual(api, StubApi.Version2);
        Name = name;
        Text = text;
    }

    /// <summary>`example.mount`</summary>
    public string Name { get; }

    /// <summary>The text, as a service sends it.</summary>
    public string Text { get; }

    /// <summary>The definitions that it imports.</summary>
    public IReadOnlyList<ServiceDefinition> Imports { get; init; } = [];

    /// <summary>Its exceptions.</summary>
    public IReadOnlyList<ExceptionType> Exceptions { get; init; } = [];

    /// <summary>Its structs, pods and namedarrays.</summary>
    public IReadOnlyList<IRecordCodec> Records { get; init; } = [];

    /// <summary>Its objects.</summary>
    public IReadOnlyList<StubFactory> Objects { get; init; } = [];

    /// <summary>Its types and those of all that it imports.</summary>
    internal KnownTypes Known => _known ??= new KnownTypes([this]);

    /// <summary>What varvalues of it and of all that it imports may hold.</summary>
    public TypeRegistry Types => Known.Registry;

    internal unsafe DefinitionHandle Handle
    {
        get
        {
            lock (_lock)
            {
                return _handle ??= MakeHandle();
            }
        }
    }

    private unsafe DefinitionHandle MakeHandle()
    {
        var imports = new nint[Imports.Count];
        for (int i = 0; i < imports.Length; ++i)
        {
            imports[i] = Imports[i].Handle.DangerousGetHandle();
        }
        using var text = new NativeText(Text);
        fixed (nint* first = imports)
        {
            nint error;
            int status = Functions.rr_definition_new(text.Value, first, (nuint)imports.Length, out nint handle, &error);
            Failure.Check(status, error, KnownTypes.None);
            return new DefinitionHandle(handle);
        }
    }
}

/// <summary>What a session or service knows of definitions.</summary>
internal sealed class KnownTypes
{
    private readonly FrozenDictionary<string, ExceptionType> _exceptions;
    private readonly FrozenDictionary<string, StubFactory> _objects;

    public KnownTypes(IEnumerable<ServiceDefinition> roots)
    {
        var seen = new HashSet<ServiceDefinition>();
        var waiting = new Queue<ServiceDefinition>(roots);
        var exceptions = new Dictionary<string, ExceptionType>(StringComparer.Ordinal);
        var objects = new Dictionary<string, StubFactory>(StringComparer.Ordinal);
        var records = new List<IRecordCodec>();
        while (waiting.TryDequeue(out ServiceDefinition? definition))
        {
            if (!seen.Add(definition))
            {
                continue;
            }
            foreach (ServiceDefinition import in definition.Imports)
            {
                waiting.Enqueue(import);
            }
            foreach (ExceptionType one in definition.Exceptions)
            {
                exceptions.TryAdd(one.Name, one);
            }
            foreach (StubFactory one in definition.Objects)
            {
                objects.TryAdd(one.Name, one);
            }
            records.AddRange(definition.Records);
        }
        _exceptions = exceptions.ToFrozenDictionary(StringComparer.Ordinal);
        _objects = objects.ToFrozenDictionary(StringComparer.Ordinal);
        Registry = new TypeRegistry(records);
    }

    public static KnownTypes None { get; } = new([]);

    public TypeRegistry Registry { get; }

    public RobdefException MakeException(ErrorCode code, string name, string message, string subName, VarValue? parameter) =>
        code == ErrorCode.RemoteError && _exceptions.TryGetValue(name, out ExceptionType? type)
            ? type.Create(message, subName, parameter)
            : Errors.Of(code, name, message, subName, parameter);

    /// <summary>A stub of the class that belongs to a type; a plain one when the program has none.</summary>
    public Stub MakeStub(ObjectHandle handle) =>
        _objects.TryGetValue(handle.TypeName, out StubFactory? factory) ? factory.Create(handle) : new Stub(handle);
}
