// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Linq;
using System.Text.Json.Nodes;
using Robdef.Runtime;

namespace Robdef.Conformance;

/// <summary>`serve`: a node with the services of service.json.</summary>
internal sealed class ServedNode(Adapters adapters)
{
    private readonly Dictionary<string, Service> _services = new(StringComparer.Ordinal);
    private Node? _node;

    public JsonNode Answer(JsonObject request)
    {
        string what = request["do"]!.GetValue<string>();
        if (what == "start")
        {
            return Start(request);
        }
        if (what != "close_service")
        {
            throw new FormatException($"unknown request {what}");
        }
        _services[request["service"]!.GetValue<string>()].Close();
        return new JsonObject { ["done"] = true };
    }

    private JsonObject Start(JsonObject request)
    {
        foreach (Service service in _services.Values)
        {
            service.Dispose();
        }
        _services.Clear();
        _node?.Dispose();
        _node = new Node(NodeSettings.Read(request));
        var services = (JsonArray)request["services"]!;
        foreach (JsonNode? service in services)
        {
            Offer(service!, services);
        }
        int port = request["port"]?.GetValue<int>() ?? 0;
        return new JsonObject { ["port"] = _node.Listen($"rr+tcp://127.0.0.1:{port}") };
    }

    private void Offer(JsonNode service, JsonArray all)
    {
        JsonNode? access = service["auth"];
        var options = new ServiceOptions
        {
            Attributes = adapters.ReadVarValues(service["attributes"]),
            Users = access?["password_file"]!.GetValue<string>() ?? "",
            UserIsOptional = (access?["policies"]?["requirevaliduser"]?.GetValue<string>() ?? "") != "true",
        };
        Skeleton root = adapters.Object(service["object"]!.GetValue<string>()).Serve(new Script(adapters, ScriptOf(service, all)));
        string name = service["name"]!.GetValue<string>();
        _services[name] = _node!.Register(name, root, options);
    }

    /// <summary>The script of a service's root: its own, or "as NAME" for that of another.</summary>
    private static JsonNode? ScriptOf(JsonNode service, JsonArray all)
    {
        const string As = "as ";
        JsonNode node = service["node"]!;
        if (node is not JsonValue)
        {
            return node;
        }
        string text = node.GetValue<string>();
        return all.Single(other => As + other!["name"]!.GetValue<string>() == text)!["node"];
    }
}
