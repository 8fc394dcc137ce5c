// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Text.Json.Nodes;
using System.Threading;
using Robdef.Runtime;

namespace Robdef.Conformance;

/// <summary>What came by itself, to be waited for.</summary>
internal sealed class Arrivals
{
    private static readonly TimeSpan s_limit = TimeSpan.FromSeconds(2);
    private readonly object _lock = new();
    private JsonArray _things = [];

    public void Add(JsonObject thing)
    {
        lock (_lock)
        {
            _things.Add(thing);
            Monitor.PulseAll(_lock);
        }
    }

    public JsonArray Wait(int count)
    {
        DateTime end = DateTime.UtcNow + s_limit;
        lock (_lock)
        {
            while (_things.Count < count && end - DateTime.UtcNow is { Ticks: > 0 } rest)
            {
                Monitor.Wait(_lock, rest);
            }
            return Clear();
        }
    }

    public JsonArray Clear()
    {
        lock (_lock)
        {
            JsonArray things = _things;
            _things = [];
            return things;
        }
    }
}

/// <summary>`call`: a node that plays plans.</summary>
internal sealed partial class CallingNode(Adapters adapters)
{
    // Codes of the recorded client's notifications.
    private const int ClientClosed = 1;
    private const int PathReleased = 5;

    private readonly Arrivals _arrivals = new();
    private readonly Dictionary<string, Client<Stub>> _clients = new(StringComparer.Ordinal);
    private readonly Dictionary<string, HeldObject> _objects = new(StringComparer.Ordinal);
    private readonly Dictionary<string, PlannedPipe> _pipes = new(StringComparer.Ordinal);
    private readonly Dictionary<string, PlannedWire> _wires = new(StringComparer.Ordinal);
    private readonly Dictionary<string, PlannedGenerator> _generators = new(StringComparer.Ordinal);
    private Node? _node;

    private sealed record HeldObject(Held Held, Caller Caller, string Client);

    public JsonNode Answer(JsonObject request)
    {
        string what = request["do"]!.GetValue<string>();
        if (what is "start" or "stop_node")
        {
            Stop();
            _node = what == "start" ? new Node(NodeSettings.Read(request)) : null;
            return new JsonObject { ["done"] = true };
        }
        try
        {
            return new JsonObject { ["result"] = Play((JsonObject)request["step"]!) };
        }
        catch (RobdefException error)
        {
            return new JsonObject { ["raised"] = Raised(error) };
        }
        catch (NotSupportedHereException reason)
        {
            return new JsonObject { ["unsupported"] = reason.Message };
        }
    }

    private static string Text(JsonObject step, string key) => step[key]!.GetValue<string>();

    private static string? Optional(JsonObject step, string key) => step[key]?.GetValue<string>();

    private static NotSupportedHereException Unknown(string operation) => new($"this runner cannot do {operation}");

    /// <summary>The node first: a client that ends by itself waits for the service to answer.</summary>
    private void Stop()
    {
        _node?.Dispose();
        _node = null;
        _pipes.Clear();
        _wires.Clear();
        _generators.Clear();
        _objects.Clear();
        _clients.Clear();
        _arrivals.Clear();
    }

    private JsonObject Raised(RobdefException error)
    {
        var raised = new JsonObject { ["code"] = (int)error.Code, ["name"] = error.Name, ["message"] = error.Message };
        if (error.SubName.Length != 0)
        {
            raised["subname"] = error.SubName;
        }
        if (error.Parameter is not null)
        {
            raised["param"] = adapters.Write("varvalue", error.Parameter);
        }
        return raised;
    }

    private JsonNode? Play(JsonObject step)
    {
        string operation = Text(step, "op");
        switch (operation)
        {
            case "connect":
                return Connect(step);
            case "disconnect":
                _clients[Text(step, "obj")].Close();
                return null;
            case "wait":
                return _arrivals.Wait(step["count"]!.GetValue<int>());
            case "drain":
                _arrivals.Clear();
                return null;
            case "sleep":
                Thread.Sleep(step["ms"]!.GetValue<int>());
                return null;
            case "get":
                return Object(step).Caller.Get(Text(step, "member"));
            case "set":
                Object(step).Caller.Set(Text(step, "member"), step["value"]);
                return null;
            case "call":
                return Object(step).Caller.Call(Text(step, "member"), step["args"]);
            case "objref":
                HeldObject parent = Object(step);
                return Keep(Text(step, "as"), parent.Client, parent.Caller.ObjRef(Text(step, "member"), step["index"]));
            case "find_object_type":
                return Object(step).Held.Stub.RrFindType(Text(step, "member"), Index(step["index"]));
            case "listen":
                return Listen(step);
            case "callback_set":
                return SetCallback(step);
            default:
                return operation.Split('_')[0] switch
                {
                    "pipe" => PlayPipe(operation, step),
                    "wire" => PlayWire(operation, step),
                    "mem" => PlayMemory(operation, step),
                    "gen" => PlayGenerator(operation, step),
                    _ => PlaySession(operation, step),
                };
        }
    }

    private JsonNode? PlaySession(string operation, JsonObject step)
    {
        // What services answer to these; the runtime takes nothing else for success.
        const string Done = "OK";
        HeldObject target = Object(step);
        switch (operation)
        {
            case "attributes":
                var attributes = new JsonObject();
                foreach ((string name, VarValue? value) in _clients[target.Client].GetAttributes())
                {
                    attributes[name] = adapters.Write("varvalue", value);
                }
                return attributes;
            case "local_services":
                return LocalServices(target);
            case "authenticate":
                _clients[target.Client].Authenticate(Text(step, "username"), adapters.ReadVarValues(step["credentials"]));
                return Done;
            case "lock":
                target.Held.Stub.RrLock(sessionOnly: step["client"]?.GetValue<bool>() ?? false);
                return Done;
            case "unlock":
                target.Held.Stub.RrUnlock();
                return Done;
            case "monitor_enter":
                int limit = step["timeout"]!.GetValue<int>();
                target.Held.Stub.RrEnterMonitor(limit < 0 ? null : TimeSpan.FromMilliseconds(limit));
                return null;
            case "monitor_exit":
                target.Held.Stub.RrExitMonitor();
                return null;
            default:
                throw Unknown(operation);
        }
    }

    private HeldObject Object(JsonObject step) => _objects[Text(step, "obj")];

    private JsonObject Keep(string name, string client, Held held)
    {
        _objects[name] = new HeldObject(held, adapters.Object(held.Type).Call(held.Stub), client);
        return new JsonObject { ["rrtype"] = held.Type };
    }

    private static ObjectIndex Index(JsonNode? index) => index switch
    {
        null => ObjectIndex.None,
        JsonValue value when value.TryGetValue(out int number) => number,
        _ => index.GetValue<string>(),
    };

    private JsonObject Connect(JsonObject step)
    {
        string name = Text(step, "as");
        var options = new ConnectOptions
        {
            UserName = Optional(step, "username") ?? "",
            ObjectType = Optional(step, "objecttype") ?? "",
            Credentials = step["credentials"] is null ? null : adapters.ReadVarValues(step["credentials"]),
            Closed = _ => _arrivals.Add(new JsonObject { ["event_type"] = ClientClosed, ["service"] = name }),
            PathReleased = path => _arrivals.Add(new JsonObject { ["event_type"] = PathReleased, ["path"] = path, ["service"] = name }),
        };
        Client<Stub> client = _node!.Connect(Text(step, "url"), adapters.Definitions, options);
        _clients[name] = client;
        return Keep(name, name, new Held(client.Root, client.Root.RrHandle.TypeName));
    }

    private JsonNode? Listen(JsonObject step)
    {
        string member = Text(step, "member");
        string name = Optional(step, "as") ?? member;
        Object(step).Caller.Listen(member, arguments => _arrivals.Add(new JsonObject { ["event"] = name, ["args"] = arguments }));
        return null;
    }

    /// <summary>The object is an ordinary one of the definition RobotRaconteurServiceIndex.</summary>
    private static JsonArray LocalServices(HeldObject index)
    {
        var services = new JsonArray();
        foreach (JsonNode? pair in Json.Items(index.Caller.Call("GetLocalNodeServices", new JsonArray())))
        {
            JsonNode service = pair![1]!;
            services.Add((JsonNode)new JsonObject
            {
                ["index"] = pair[0]!.DeepClone(),
                ["name"] = service["Name"]!.DeepClone(),
                ["type"] = service["RootObjectType"]!.DeepClone(),
            });
        }
        return services;
    }
}
