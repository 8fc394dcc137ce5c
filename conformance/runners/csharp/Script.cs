// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Linq;
using System.Runtime.CompilerServices;
using System.Text.Json.Nodes;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime;

namespace Robdef.Conformance;

/// <summary>
/// What one object is told to do, a node of service.json, and its state. Used by any thread. Functions that drive
/// other members are known by their names: `fire_EVENT`, `send_PIPE`, `close_PIPE`, `received_count`, `send_WIRE`,
/// `close_WIRE`, `last_WIRE`, `call_CALLBACK`, `release_child`; with `_later` behind it a function does so when it has been
/// answered. An outcome with `does` gives such a name to any function.
/// </summary>
internal sealed class Script(Adapters adapters, JsonNode? node)
{
    private const string Later = "_later";
    /// <summary>An answer is long gone then.</summary>
    private static readonly TimeSpan Delay = TimeSpan.FromMilliseconds(50);
    /// <summary>Whose call put off what is done now; 0 for nobody's.</summary>
    private static readonly AsyncLocal<uint> PutOffFor = new();

    private readonly Lock _lock = new();
    private readonly JsonObject _node = (JsonObject)(node?.DeepClone() ?? new JsonObject());
    private readonly Dictionary<string, Func<Type, JsonNode?>> _actions = new(StringComparer.Ordinal);
    private readonly Dictionary<string, int> _calls = new(StringComparer.Ordinal);
    private readonly Dictionary<string, Skeleton> _children = new(StringComparer.Ordinal);
    private ObjectMonitor? _monitor;
    private Service? _service;
    private int _received;

    public Adapters Adapters => adapters;

    /// <summary>Called when the service reaches the object.</summary>
    public void Attach(Service service) => _service = service;

    /// <summary>A monitor, which those objects have that have a member without lock.</summary>
    public ObjectMonitor? MonitorOf(ServedType type)
    {
        if (type.Members.Any(member => (member.Access & MemberAccess.NoLock) != 0))
        {
            Interlocked.CompareExchange(ref _monitor, new ObjectMonitor(), null);
        }
        return _monitor;
    }

    /// <summary>`fire` gets the arguments of one event.</summary>
    public void AddEvent(string name, Action<Arguments> fire) => _actions["fire_" + name] = _ =>
    {
        foreach (JsonNode? arguments in Json.Items(Told("events", name) ?? new JsonArray()))
        {
            fire(new Arguments(adapters, arguments));
        }
        return null;
    };

    public void AddPipe<T>(string name, string type, PipeServer<T> pipe)
    {
        Adapter<T> adapter = adapters.Of<T>(type);
        pipe.SetConnectHandler(end => end.SetHandler(_ => Interlocked.Increment(ref _received)));
        _actions["received_count"] = _ => _received;
        _actions["send_" + name] = _ =>
        {
            foreach (PipeEndpoint<T> end in pipe.GetEndpoints())
            {
                foreach (JsonNode? entry in Json.Items(Told("pipes", name) ?? new JsonArray()))
                {
                    end.AskForAcknowledgements(Json.Part(entry, "ack")?.GetValue<bool>() ?? false);
                    end.Send(adapter.Read(Json.Part(entry, "packet")));
                }
            }
            return null;
        };
        _actions["close_" + name] = _ =>
        {
            Array.ForEach(pipe.GetEndpoints(), end => end.Close());
            return null;
        };
    }

    public void AddWire<T>(string name, string type, WireServer<T> wire)
    {
        Adapter<T> adapter = adapters.Of<T>(type);
        T Scripted(string key) => Told("wires", name) is JsonObject values && values.ContainsKey(key)
            ? adapter.Read(values[key])
            : throw NotSet();
        wire.SetHandler(null, null, () => Scripted("peek_in"),
            () => wire.TryGetReceived(out WireValue<T> newest) ? newest.Value : Scripted("peek_out"));
        _actions["send_" + name] = _ =>
        {
            foreach (JsonNode? value in Json.Items(Json.Part(Told("wires", name), "send") ?? new JsonArray()))
            {
                wire.Send(adapter.Read(value));
            }
            return null;
        };
        _actions["last_" + name] = _ => wire.TryGetReceived(out WireValue<T> newest) ? adapter.Write(newest.Value) : throw NotSet();
        _actions["close_" + name] = _ =>
        {
            Array.ForEach(wire.GetConnections(), end => end.Close());
            return null;
        };
    }

    /// <summary>`call` calls the function of a client. A function of another type than this tells the error as a text.</summary>
    public void AddCallback(string name, string type, Func<uint, Arguments, JsonNode?> call) => _actions["call_" + name] = wanted =>
    {
        Type result = type == "void" ? typeof(void) : adapters.Of(type).Type;
        try
        {
            uint client = PutOffFor.Value != 0 ? PutOffFor.Value : Skeleton.RrCurrentClient;
            return call(client, new Arguments(adapters, Told("callbacks", name)));
        }
        catch (RobdefException error) when (wanted != result)
        {
            return $"{error.Name}: {error.Message}";
        }
    };

    public ValueTask<T> Get<T>(string property, string type, T initial)
    {
        lock (_lock)
        {
            JsonNode? entry = Json.Part(_node["properties"], property);
            if (Json.Part(entry, "get_throw") is { } error)
            {
                throw Outcomes.ExceptionOf(adapters, error, null);
            }
            return new(Json.Part(entry, "value") is { } value ? adapters.Read<T>(type, value) : initial);
        }
    }

    public ValueTask Set<T>(string property, string type, T value)
    {
        lock (_lock)
        {
            var properties = (JsonObject)(_node["properties"] ??= new JsonObject());
            var entry = (JsonObject)(properties[property] ??= new JsonObject());
            if (entry["set_throw"] is { } error)
            {
                throw Outcomes.ExceptionOf(adapters, error, null);
            }
            entry["value"] = adapters.Write(type, value);
        }
        return default;
    }

    /// <summary>The outcome of the next call of a function.</summary>
    public ValueTask<T> Call<T>(string function, string type, T initial, JsonArray parameters)
    {
        JsonNode? result = Outcome(function, parameters, typeof(T));
        return new(result is null ? initial : adapters.Read<T>(type, result));
    }

    /// <summary>The same of a function without a result.</summary>
    public ValueTask Call(string function, JsonArray parameters)
    {
        Outcome(function, parameters, typeof(void));
        return default;
    }

    /// <summary>Of a generator that gives values.</summary>
    public IAsyncEnumerable<T> Source<T>(string function, string type, JsonArray parameters) =>
        Yield<T>(new ScriptedSteps(adapters, NextOutcome(function, parameters)), type);

    /// <summary>Of a generator that takes values.</summary>
    public ValueTask Sink<T>(string function, IAsyncEnumerable<T> values, JsonArray parameters) =>
        Take(new ScriptedSteps(adapters, NextOutcome(function, parameters)), values);

    /// <summary>Of a generator that takes and gives values.</summary>
    public IAsyncEnumerable<T> Filter<TIn, T>(string function, string type, IAsyncEnumerable<TIn> values, JsonArray parameters) =>
        Change<TIn, T>(new ScriptedSteps(adapters, NextOutcome(function, parameters)), type, values);

    public ArrayMemorySource<T> ArrayMemory<T>(string name, string type) => new StoredArrayMemory<T>(
        Told("memories", name) is { } content ? adapters.Read<T[]>(type, content) : []);

    public MultiDimMemorySource<T> MultiDimMemory<T>(string name, string type) => new StoredMultiDimMemory<T>(
        Told("memories", name) is { } content ? adapters.Read<MultiDimArray<T>>(type, content) : new MultiDimArray<T>());

    /// <summary>The object that an objref gives; the index is null for one without. InvalidArgument for an unknown index.</summary>
    public ValueTask<Skeleton> Child(string objref, object? index = null)
    {
        string text = index?.ToString() ?? "";
        lock (_lock)
        {
            string key = $"{objref}[{text}]";
            if (_children.TryGetValue(key, out Skeleton? made))
            {
                return new(made);
            }
            JsonNode? entry = Json.Part(_node["objrefs"], objref);
            if (entry is not null && index is not null)
            {
                entry = Json.Part(entry["items"], text)
                    ?? throw new RobdefException(ErrorCode.InvalidArgument, $"no object with index {text}");
            }
            if (entry is null)
            {
                return new((Skeleton)null!);
            }
            return new(_children[key] = adapters.Object(entry["type"]!.GetValue<string>()).Serve(new Script(adapters, entry["node"])));
        }
    }

    private static RobdefException NotSet() => new(ErrorCode.ValueNotSet, "Value not set");

    /// <summary>What the script says about a member that is no function.</summary>
    private JsonNode? Told(string kind, string name)
    {
        lock (_lock)
        {
            return Json.Part(_node[kind], name)?.DeepClone();
        }
    }

    private JsonNode? Outcome(string function, JsonArray parameters, Type wanted)
    {
        if (!SaysWhatItDoes(function) && TryAct(function, parameters, wanted, out JsonNode? done))
        {
            return done;
        }
        JsonNode? next = NextOutcome(function, parameters);
        if (Json.Part(next, "does") is { } other)
        {
            return TryAct(other.GetValue<string>(), parameters, wanted, out done)
                ? done
                : throw new InvalidOperationException($"nothing is called {other.ToJsonString()}");
        }
        return Json.Part(next, "echo") is { } place ? parameters[place.GetValue<int>()] : Json.Part(next, "return");
    }

    /// <summary>Whether an outcome says what the function does, whatever its name says.</summary>
    private bool SaysWhatItDoes(string function) => Told("functions", function) switch
    {
        JsonArray outcomes => outcomes.OfType<JsonObject>().Any(outcome => outcome.ContainsKey("does")),
        JsonObject outcome => outcome.ContainsKey("does"),
        _ => false,
    };

    /// <summary>Does what a function of this name is for; false for a name that says nothing.</summary>
    private bool TryAct(string name, JsonArray parameters, Type wanted, out JsonNode? result)
    {
        result = null;
        if (name == "release_child")
        {
            _service!.ReleasePath($"{_service.Name}.{parameters[0]!.GetValue<string>()}");
            return true;
        }
        if (_actions.TryGetValue(name, out Func<Type, JsonNode?>? action))
        {
            result = action(wanted);
            return true;
        }
        if (!name.EndsWith(Later, StringComparison.Ordinal) || !_actions.TryGetValue(name[..^Later.Length], out action))
        {
            return false;
        }
        string member = name[(name.IndexOf('_', StringComparison.Ordinal) + 1)..^Later.Length];
        _ = DoLater(name, Skeleton.RrCurrentClient, () =>
        {
            action(typeof(void));
            _actions.GetValueOrDefault("fire_answered_" + member)?.Invoke(typeof(void));
        });
        return true;
    }

    private static async Task DoLater(string name, uint client, Action what)
    {
        await Task.Delay(Delay).ConfigureAwait(false);
        PutOffFor.Value = client;
        try
        {
            what();
        }
        catch (RobdefException)
        {
            // Whom it was for has gone.
        }
        catch (Exception error) when (error is not OutOfMemoryException)
        {
            await Console.Error.WriteLineAsync($"{name}: {error}").ConfigureAwait(false);
        }
    }

    private JsonNode? NextOutcome(string function, JsonArray parameters)
    {
        int call;
        lock (_lock)
        {
            call = _calls.GetValueOrDefault(function);
            _calls[function] = call + 1;
        }
        JsonNode? next = Outcomes.OfCall(Told("functions", function), call);
        return Json.Part(next, "throw") is { } error ? throw Outcomes.ExceptionOf(adapters, error, parameters) : next;
    }

    private async IAsyncEnumerable<T> Yield<T>(ScriptedSteps steps, string type)
    {
        await Task.Yield();
        while (steps.Take() is { } step)
        {
            yield return adapters.Read<T>(type, steps.Given(step));
        }
    }

    private static async ValueTask Take<T>(ScriptedSteps steps, IAsyncEnumerable<T> values)
    {
        await foreach (T _ in values)
        {
            if (steps.Take() is null)
            {
                return;
            }
        }
    }

    private async IAsyncEnumerable<T> Change<TIn, T>(ScriptedSteps steps, string type, IAsyncEnumerable<TIn> values,
        [EnumeratorCancellation] CancellationToken cancel = default)
    {
        await foreach (TIn _ in values.WithCancellation(cancel))
        {
            if (steps.Take() is not { } step)
            {
                yield break;
            }
            yield return adapters.Read<T>(type, steps.Given(step));
        }
    }
}

/// <summary>The steps that a script tells: `yield` values or `accept` so many, then the end, or instead of it the error `end`.</summary>
internal sealed class ScriptedSteps(Adapters adapters, JsonNode? script)
{
    private readonly int _count = (Json.Part(script, "yield") as JsonArray)?.Count ?? Json.Part(script, "accept")?.GetValue<int>() ?? 0;
    private int _step;

    /// <summary>The number of the next step; null at the end.</summary>
    public int? Take()
    {
        if (_step < _count)
        {
            return _step++;
        }
        return Json.Part(script, "end") is { } error ? throw Outcomes.ExceptionOf(adapters, error, null) : null;
    }

    /// <summary>What a step gives.</summary>
    public JsonNode? Given(int step) => Json.Part(script, "yield")![step];
}
