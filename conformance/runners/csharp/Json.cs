// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Numerics;
using System.Text.Json;
using System.Text.Json.Nodes;

namespace Robdef.Conformance;

/// <summary>Numbers and lists in the notation of the captures.</summary>
internal static class Json
{
    private const long PlainNan = 0x7FF8000000000000;
    private const int PlainNanSingle = 0x7FC00000;
    private const string NanBits = "NaN:0x";

    /// <summary>A part of an object; null where there is no object or no such part.</summary>
    public static JsonNode? Part(JsonNode? json, string key) => (json as JsonObject)?[key];

    /// <summary>The items of a list. Throws for anything else.</summary>
    public static IEnumerable<JsonNode?> Items(JsonNode? json) => json as JsonArray
        ?? throw new FormatException($"not a list: {json?.ToJsonString()}");

    public static T To<T>(JsonNode json)
        where T : IBinaryInteger<T> => T.Parse(json.ToString(), NumberStyles.AllowLeadingSign, CultureInfo.InvariantCulture);

    public static JsonNode Text<T>(T number)
        where T : IFormattable => JsonValue.Create(number.ToString(null, CultureInfo.InvariantCulture));

    public static double ToDouble(JsonNode json)
    {
        string text = json.ToString();
        return text switch
        {
            "NaN" => BitConverter.Int64BitsToDouble(PlainNan),
            "Infinity" => double.PositiveInfinity,
            "-Infinity" => double.NegativeInfinity,
            _ when text.StartsWith(NanBits, StringComparison.Ordinal) => BitConverter.UInt64BitsToDouble(
                ulong.Parse(text[NanBits.Length..], NumberStyles.HexNumber, CultureInfo.InvariantCulture)),
            _ => double.Parse(text, CultureInfo.InvariantCulture),
        };
    }

    public static float ToSingle(JsonNode json)
    {
        string text = json.ToString();
        return text switch
        {
            "NaN" => BitConverter.Int32BitsToSingle(PlainNanSingle),
            "Infinity" => float.PositiveInfinity,
            "-Infinity" => float.NegativeInfinity,
            _ when text.StartsWith(NanBits, StringComparison.Ordinal) => BitConverter.UInt32BitsToSingle(
                uint.Parse(text[NanBits.Length..], NumberStyles.HexNumber, CultureInfo.InvariantCulture)),
            _ => (float)double.Parse(text, CultureInfo.InvariantCulture),
        };
    }

    public static JsonNode Of(double value)
    {
        if (double.IsNaN(value))
        {
            long bits = BitConverter.DoubleToInt64Bits(value);
            return bits == PlainNan ? "NaN" : $"{NanBits}{bits:x16}";
        }
        return double.IsFinite(value) ? Number(value.ToString("R", CultureInfo.InvariantCulture)) : Infinite(value > 0);
    }

    /// <summary>A single is its shortest decimal.</summary>
    public static JsonNode Of(float value)
    {
        if (float.IsNaN(value))
        {
            int bits = BitConverter.SingleToInt32Bits(value);
            return bits == PlainNanSingle ? "NaN" : $"{NanBits}{bits:x8}";
        }
        return float.IsFinite(value) ? Number(value.ToString("R", CultureInfo.InvariantCulture)) : Infinite(value > 0);
    }

    private static JsonNode Infinite(bool isPositive) => isPositive ? "Infinity" : "-Infinity";

    /// <summary>As it is spelled, so that -0 keeps its sign.</summary>
    private static JsonNode Number(string text) => JsonNode.Parse(text == "-0" ? "-0.0" : text)!;
}
