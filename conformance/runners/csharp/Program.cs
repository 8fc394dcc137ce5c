// SPDX-License-Identifier: Apache-2.0
// The C# runner: one of four verbs, a line of JSON in, a line of JSON out, until its input ends.
using System;
using System.Linq;
using System.Text.Encodings.Web;
using System.Text.Json;
using System.Text.Json.Nodes;

namespace Robdef.Conformance;

internal static class Program
{
    private static readonly JsonSerializerOptions s_plain = new() { Encoder = JavaScriptEncoder.UnsafeRelaxedJsonEscaping, MaxDepth = 512 };

    private static int Main(string[] arguments)
    {
        var adapters = new Adapters();
        foreach (Type type in typeof(Program).Assembly.GetTypes().Where(one => one.IsClass && one.IsAssignableTo(typeof(IAddAdapters))))
        {
            ((IAddAdapters)Activator.CreateInstance(type)!).AddTo(adapters);
        }
        Func<JsonObject, JsonNode>? answer = arguments switch
        {
            ["decode"] => new CodecVerbs(adapters).Decode,
            ["encode"] => new CodecVerbs(adapters).Encode,
            ["serve"] => new ServedNode(adapters).Answer,
            ["call"] => new CallingNode(adapters).Answer,
            _ => null,
        };
        if (answer is null)
        {
            Console.Error.WriteLine("usage: conformance_runner decode|encode|serve|call");
            return 2;
        }
        while (Console.ReadLine() is { } line)
        {
            Console.WriteLine(Answer(answer, line).ToJsonString(s_plain));
        }
        return 0;
    }

    private static JsonNode Answer(Func<JsonObject, JsonNode> answer, string line)
    {
        try
        {
            var request = (JsonObject)JsonNode.Parse(line, null, new JsonDocumentOptions { MaxDepth = 512 })!;
            return answer(request);
        }
        catch (Exception exception)
        {
            return new JsonObject { ["error"] = exception.ToString() };
        }
    }
}
