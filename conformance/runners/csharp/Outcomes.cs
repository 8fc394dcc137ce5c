// SPDX-License-Identifier: Apache-2.0
using System;
using System.Globalization;
using System.Text.Json.Nodes;
using Robdef.Runtime;

namespace Robdef.Conformance;

/// <summary>What members are told to do.</summary>
internal static class Outcomes
{
    /// <summary>
    /// What the call with this number, counted from 0, is to give: outcomes are for one call each, and the last one is
    /// for all calls to come. An outcome that is no list is for all.
    /// </summary>
    public static JsonNode? OfCall(JsonNode? outcomes, int call) => outcomes is JsonArray { Count: > 0 } list
        ? list[Math.Min(call, list.Count - 1)]
        : outcomes;

    /// <summary>
    /// The exception that the `throw` of an outcome says; a "$n" stands for parameter n of the call. Code 100 is a
    /// remote error of any name; another code has its own name, and free are those of 16 and of codes that the protocol
    /// does not know.
    /// </summary>
    public static Exception ExceptionOf(Adapters adapters, JsonNode what, JsonArray? parameters)
    {
        JsonNode? Given(string key)
        {
            JsonNode? value = Json.Part(what, key);
            return value is JsonValue text && text.TryGetValue(out string? name) && name.Length == 2 && name[0] == '$'
                ? parameters![int.Parse(name[1..], CultureInfo.InvariantCulture)]
                : value;
        }
        string TextOf(string key) => Given(key)?.GetValue<string>() ?? "";
        if (Json.Part(what, "native") is not null)
        {
            return new InvalidOperationException(TextOf("native"));
        }
        var code = (ErrorCode)Json.To<int>(Given("code")!);
        bool isNamed = code is ErrorCode.RemoteError or ErrorCode.UnknownError || RobdefException.NameOf(code).Length == 0;
        string name = isNamed ? TextOf("name") : RobdefException.NameOf(code);
        return new RobdefException(code, name, TextOf("message"), TextOf("subname"), adapters.ReadVarValue(Given("param")));
    }
}
