// SPDX-License-Identifier: Apache-2.0
using System;
using System.Text.Json.Nodes;
using System.Threading.Tasks;
using Robdef.Runtime;

namespace Robdef.Conformance;

/// <summary>Thrown for what this runner does not have: said to the suite as such.</summary>
internal sealed class NotSupportedHereException(string reason) : Exception(reason);

/// <summary>An object that a plan holds, and the type it is held as.</summary>
internal sealed record Held(Stub Stub, string Type);

/// <summary>Arguments in the notation of the captures, taken from the first to the last.</summary>
internal sealed class Arguments(Adapters adapters, JsonNode? list)
{
    private readonly JsonArray _list = (JsonArray)list!;
    private int _next;

    public T Next<T>(string type) => adapters.Read<T>(type, _list[_next++]);
}

/// <summary>
/// A stub whose members are called by name with values in the notation of the captures. Generated adapters implement
/// it with the typed members of the stub.
/// </summary>
internal abstract class Caller(Adapters adapters)
{
    public virtual JsonNode? Get(string member) => throw None("property to get", member);

    public virtual void Set(string member, JsonNode? value) => throw None("property to set", member);

    /// <summary>Null for a void function.</summary>
    public virtual JsonNode? Call(string member, JsonNode? arguments) => throw None("function", member);

    public virtual Held ObjRef(string member, JsonNode? index) => throw None("objref", member);

    public virtual void Listen(string member, Action<JsonArray> handler) => throw None("event", member);

    /// <summary>Connects a new endpoint, with this index or -1.</summary>
    public virtual PlannedPipe Pipe(string member, int index, Action<JsonObject> arrive) => throw None("pipe", member);

    /// <summary>Not yet connected.</summary>
    public virtual PlannedWire Wire(string member) => throw None("wire", member);

    public virtual PlannedMemory Memory(string member) => throw None("memory", member);

    public virtual PlannedGenerator Generate(string member, JsonNode? arguments) => throw None("generator function", member);

    /// <summary>The function gets the list of the parameters of each call, on any thread.</summary>
    public virtual void SetCallback(string member, Func<JsonArray, JsonNode?> answer) => throw None("callback", member);

    // What generated code uses.
    protected Adapters Adapters => adapters;

    protected Adapter<T> Of<T>(string type) => adapters.Of<T>(type);

    protected T Read<T>(string type, JsonNode? json) => adapters.Read<T>(type, json);

    protected JsonNode? Write<T>(string type, T value) => adapters.Write(type, value);

    /// <summary>Functions are called asynchronously, so that both forms of calls are seen: properties are not.</summary>
    protected static T Wait<T>(Task<T> task) => task.GetAwaiter().GetResult();

    protected static JsonNode? Wait(Task task)
    {
        task.GetAwaiter().GetResult();
        return null;
    }

    /// <summary>A varobject has no declared type: it is held as what it is.</summary>
    protected static Held Hold(object stub, string type) =>
        new((Stub)stub, type.Length == 0 ? ((Stub)stub).RrHandle.TypeName : type);

    private static NotSupportedHereException None(string kind, string member) => new($"the generated code has no {kind} {member}");
}
