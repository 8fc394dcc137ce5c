// SPDX-License-Identifier: Apache-2.0
using System;
using System.Linq;
using System.Runtime.InteropServices;
using System.Text;
using System.Text.Json.Nodes;
using Robdef.Runtime;

namespace Robdef.Conformance;

/// <summary>
/// `decode` and `encode`. Values are read and written by the runtime for C#; messages, and elements without their
/// types, by what it stands on, since a program in C# never sees them.
/// </summary>
internal sealed partial class CodecVerbs(Adapters adapters)
{
    private readonly TypeRegistry _types = adapters.Types;

    public JsonNode Decode(JsonObject request)
    {
        JsonNode answer = AskNative(request);
        if (request["do"]!.GetValue<string>() == "element" && answer["decoded"] is not null)
        {
            byte[] bytes = Convert.FromHexString(request["hex"]!.GetValue<string>());
            var reader = new ElementReader(bytes, VersionOf(request), _types);
            answer["value"] = adapters.Of(TypeOf(request)).Unpack(reader.Read());
        }
        return answer;
    }

    public JsonNode Encode(JsonObject request)
    {
        if (request["do"]!.GetValue<string>() != "value")
        {
            return AskNative(request);
        }
        using var writer = new ElementWriter(VersionOf(request));
        try
        {
            Pack(request, writer);
        }
        catch (RobdefException refused)
        {
            return new JsonObject { ["refused"] = refused.Message };
        }
        return new JsonObject { ["hex"] = Convert.ToHexStringLower(writer.Written) };
    }

    private static MessageVersion VersionOf(JsonObject request) => (MessageVersion)request["message_version"]!.GetValue<int>();

    /// <summary>A definition spells no type for the null of a varvalue, the captures do.</summary>
    private static string TypeOf(JsonObject request)
    {
        string type = request["type"]!.GetValue<string>();
        return type == "void" ? "varvalue" : type;
    }

    private void Pack(JsonObject request, ElementWriter writer)
    {
        byte[] metadata = Encoding.UTF8.GetBytes(request["metadata"]?.GetValue<string>() ?? "");
        byte[] extended = Convert.FromHexString(request["extended"]?.GetValue<string>() ?? "");
        byte[] name = Encoding.UTF8.GetBytes(request["element_name"]?.GetValue<string>() ?? "");
        ElementKey key = request["element_number"] is { } number
            ? new ElementKey(number.GetValue<int>()) { Metadata = metadata, Extended = extended }
            : new ElementKey(name) { Metadata = metadata, Extended = extended };
        adapters.Of(TypeOf(request)).Pack(writer, key, request["value"]);
    }

    private static JsonNode AskNative(JsonObject request)
    {
        nint text = conformance_answer(request.ToJsonString());
        try
        {
            return JsonNode.Parse(Marshal.PtrToStringUTF8(text)!, null, new() { MaxDepth = 512 })!;
        }
        finally
        {
            conformance_free(text);
        }
    }

#pragma warning disable IDE1006 // Names as they are there.
    [LibraryImport("conformance_messages", StringMarshalling = StringMarshalling.Utf8)]
    private static partial nint conformance_answer(string line);

    [LibraryImport("conformance_messages")]
    private static partial void conformance_free(nint text);
#pragma warning restore IDE1006
}
