// SPDX-License-Identifier: Apache-2.0
using System;
using System.Text.Json.Nodes;
using Robdef.Runtime;

namespace Robdef.Conformance;

/// <summary>The node that a `start` request asks for.</summary>
internal static class NodeSettings
{
    // Capability codes are a page and flags (04, section 4.4).
    private const uint PageMask = 0xFFF00000;
    private const uint MessageV2Page = 0x02000000;
    private const uint MessageV4Page = 0x04000000;
    private const uint StringTablePage = 0x04100000;
    private const uint EnabledFlag = 0x1;
    private const uint CombinedConnectFlag = 0x2;

    // What NodeOptions.ServerWithout counts.
    private const int WithoutV4 = 1;
    private const int WithoutStringTable = 2;
    private const int WithoutCombinedConnect = 4;

    public static NodeOptions Read(JsonObject request)
    {
        JsonNode node = request["node"]!;
        bool hasStringTable = request["string_table"]!.GetValue<bool>();
        int without = 0;
        foreach (JsonNode? capability in request["withheld_capabilities"] as JsonArray ?? [])
        {
            without |= Withheld(capability!.GetValue<uint>());
        }
        return new NodeOptions
        {
            Id = Guid.Parse(node["id"]!.GetValue<string>()),
            Name = node["name"]!.GetValue<string>(),
            ClientWithoutVersion4 = request["message_version"]!.GetValue<int>() != 4,
            ClientWithoutStringTable = !hasStringTable,
            ServerStringTable = hasStringTable,
            ServerWithout = without,
            // What recordings throw that is no error of the protocol is told as the reference does.
            EnableDetailedErrors = true,
            HeartbeatPeriod = request["heartbeat_ms"] is { } period ? TimeSpan.FromMilliseconds(period.GetValue<int>()) : null,
            MemoryTransferLimit = Json.Part(request["node_options"], "memory_max_transfer")?.GetValue<int>() ?? 0,
        };
    }

    private static int Withheld(uint capability)
    {
        uint page = capability & PageMask;
        bool isOfMessages = page is MessageV2Page or MessageV4Page;
        int without = isOfMessages && (capability & CombinedConnectFlag) != 0 ? WithoutCombinedConnect : 0;
        if (page == MessageV4Page && (capability & EnabledFlag) != 0)
        {
            without |= WithoutV4;
        }
        return page == StringTablePage ? without | WithoutStringTable : without;
    }
}
