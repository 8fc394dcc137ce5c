// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;
using System.Text.Json;
using System.Text.RegularExpressions;
using Conformance.Types;
using Xunit;
using Complex = System.Numerics.Complex;

namespace Robdef.Runtime.Tests;

/// <summary>Every recorded value is read as what it is recorded to be, and written as the same bytes.</summary>
public sealed partial class CaptureTests
{
    private static string Captures => Environment.GetEnvironmentVariable("ROBDEF_CAPTURES_DIR")
        ?? throw new InvalidOperationException("ROBDEF_CAPTURES_DIR says where the captures are");

    [Theory]
    [InlineData("values-v2.json", MessageVersion.V2, 250)]
    [InlineData("values-v4.json", MessageVersion.V4, 250)]
    public void Every_value_is_read_and_written_byte_for_byte(string file, MessageVersion version, int atLeast)
    {
        using JsonDocument document = JsonDocument.Parse(File.ReadAllText(Path.Combine(Captures, file)));
        int count = 0;
        foreach (JsonElement value in document.RootElement.GetProperty("values").EnumerateArray())
        {
            string name = value.GetProperty("name").GetString()!;
            IRoundTrip codec = RoundTrips.Of(value.GetProperty("robdef_type").GetString()!);
            if (value.TryGetProperty("refused", out _))
            {
                Assert.ThrowsAny<RobdefException>(() => Write(codec, 1, value, version));
                continue;
            }
            byte[] bytes = Bytes(value.GetProperty("hex").GetString()!);
            object? read = Read(codec, bytes, value, version);
            AssertSame(value.GetProperty("value"), read, name);
            Assert.True(bytes.AsSpan().SequenceEqual(Write(codec, read, value, version)), name);
            ++count;
        }
        Assert.True(count >= atLeast, $"only {count} values");
    }

    [Theory]
    [InlineData("values-v2.json", MessageVersion.V2)]
    [InlineData("values-v4.json", MessageVersion.V4)]
    public void Every_prefix_of_a_value_is_refused(string file, MessageVersion version)
    {
        using JsonDocument document = JsonDocument.Parse(File.ReadAllText(Path.Combine(Captures, file)));
        foreach (JsonElement value in document.RootElement.GetProperty("values").EnumerateArray().Where(one => one.TryGetProperty("hex", out _)))
        {
            IRoundTrip codec = RoundTrips.Of(value.GetProperty("robdef_type").GetString()!);
            byte[] bytes = Bytes(value.GetProperty("hex").GetString()!);
            int step = Math.Max(1, bytes.Length / 12);
            for (int length = 0; length < bytes.Length; length += step)
            {
                byte[] prefix = bytes[..length];
                Assert.ThrowsAny<RobdefException>(() => codec.Read(new ElementReader(prefix, version, Types).Read()));
            }
        }
    }

    [Theory]
    [InlineData("values-v2.json", MessageVersion.V2)]
    [InlineData("values-v4.json", MessageVersion.V4)]
    public void A_changed_byte_is_refused_or_read(string file, MessageVersion version)
    {
        using JsonDocument document = JsonDocument.Parse(File.ReadAllText(Path.Combine(Captures, file)));
        foreach (JsonElement value in document.RootElement.GetProperty("values").EnumerateArray().Where(one => one.TryGetProperty("hex", out _)))
        {
            IRoundTrip codec = RoundTrips.Of(value.GetProperty("robdef_type").GetString()!);
            byte[] bytes = Bytes(value.GetProperty("hex").GetString()!);
            int step = Math.Max(1, bytes.Length / 12);
            for (int place = 0; place < bytes.Length; place += step)
            {
                byte[] changed = [.. bytes];
                changed[place] ^= 0x41;
                try
                {
                    _ = codec.Read(new ElementReader(changed, version, Types).Read());
                }
                catch (RobdefException)
                {
                    // Refused, which is as good.
                }
            }
        }
    }

    private static TypeRegistry Types => Conformance.Types.RrDefinition.Value.Types;

    private static object? Read(IRoundTrip codec, byte[] bytes, JsonElement value, MessageVersion version)
    {
        Element element = new ElementReader(bytes, version, Types).Read();
        if (value.TryGetProperty("metadata", out JsonElement metadata))
        {
            Assert.Equal(Text(metadata), Encoding.UTF8.GetString(element.Metadata));
        }
        return codec.Read(element);
    }

    private static byte[] Write(IRoundTrip codec, object? read, JsonElement value, MessageVersion version)
    {
        using var writer = new ElementWriter(version);
        byte[] metadata = value.TryGetProperty("metadata", out JsonElement text) ? Encoding.UTF8.GetBytes(Text(text)) : [];
        byte[] extended = value.TryGetProperty("extended", out JsonElement list)
            ? [.. list.EnumerateArray().Select(one => one.GetByte())]
            : [];
        if (value.TryGetProperty("element_number", out JsonElement number))
        {
            codec.Write(writer, new ElementKey(number.GetInt32()) { Metadata = metadata, Extended = extended }, read);
        }
        else
        {
            byte[] name = Encoding.UTF8.GetBytes(Text(value.GetProperty("element_name")));
            codec.Write(writer, new ElementKey(name) { Metadata = metadata, Extended = extended }, read);
        }
        return writer.Written.ToArray();
    }

    /// <summary>Hex with `{hh*n}` for a byte that repeats.</summary>
    private static byte[] Bytes(string hex) => Convert.FromHexString(Repeats().Replace(hex,
        match => string.Concat(Enumerable.Repeat(match.Groups[1].Value, int.Parse(match.Groups[2].Value, CultureInfo.InvariantCulture)))));

    [GeneratedRegex(@"\{([0-9a-f]{2})\*(\d+)\}")]
    private static partial Regex Repeats();

    private static string Text(JsonElement text) => text.ValueKind == JsonValueKind.Object
        ? string.Concat(Enumerable.Repeat(text.GetProperty("repeat").GetString(), text.GetProperty("count").GetInt32()))
        : text.GetString()!;

    private static void AssertSame(JsonElement expected, object? actual, string name)
    {
        switch (actual)
        {
            case null:
                Assert.Equal(JsonValueKind.Null, expected.ValueKind);
                break;
            case string text:
                Assert.Equal(Text(expected), text);
                break;
            case bool truth:
                Assert.Equal(expected.GetBoolean(), truth);
                break;
            case Complex complex:
                AssertSame(expected[0], complex.Real, name);
                AssertSame(expected[1], complex.Imaginary, name);
                break;
            case ComplexSingle complex:
                AssertSame(expected[0], complex.Real, name);
                AssertSame(expected[1], complex.Imaginary, name);
                break;
            case float or double:
                AssertSameFloat(expected, actual, name);
                break;
            case Enum:
                Assert.Equal(expected.GetInt32(), Convert.ToInt32(actual, CultureInfo.InvariantCulture));
                break;
            case VarValue value:
                // The item type of a container is not told again for each of its items.
                AssertSame(expected.ValueKind == JsonValueKind.Object && expected.TryGetProperty("type", out _)
                    ? expected.GetProperty("value") : expected, value.Value, name);
                break;
            case IDictionary map:
                Assert.Equal(expected.GetArrayLength(), map.Count);
                foreach (JsonElement pair in expected.EnumerateArray())
                {
                    object key = pair[0].ValueKind == JsonValueKind.Number ? pair[0].GetInt32() : Text(pair[0]);
                    AssertSame(pair[1], map[key], name);
                }
                break;
            case IList list:
                AssertSameItems(expected, list, name);
                break;
            case IConvertible number:
                Assert.Equal(expected.ToString(), number.ToString(CultureInfo.InvariantCulture));
                break;
            default:
                AssertSameRecord(expected, actual, name);
                break;
        }
    }

    private static void AssertSameFloat(JsonElement expected, object actual, string name)
    {
        string text = expected.ToString();
        if (text.StartsWith("NaN", StringComparison.Ordinal))
        {
            Assert.True(actual is double.NaN or float.NaN, name);
            return;
        }
        if (actual is float single)
        {
            Assert.Equal(float.Parse(text, CultureInfo.InvariantCulture), single);
            return;
        }
        Assert.Equal(double.Parse(text, CultureInfo.InvariantCulture), (double)actual);
    }

    private static void AssertSameItems(JsonElement expected, IList actual, string name)
    {
        if (expected.ValueKind == JsonValueKind.Object)
        {
            Assert.Equal(expected.GetProperty("count").GetInt32(), actual.Count);
            foreach (object? item in actual)
            {
                AssertSame(expected.GetProperty("repeat"), item, name);
            }
            return;
        }
        // A single number or namedarray in a varvalue arrives as an array of one.
        bool isOne = expected.ValueKind != JsonValueKind.Array
            || (actual.Count == 1 && actual[0] is ValueType and not IConvertible && expected[0].ValueKind != JsonValueKind.Array);
        if (isOne)
        {
            Assert.Single(actual);
            AssertSame(expected, actual[0], name);
            return;
        }
        Assert.Equal(expected.GetArrayLength(), actual.Count);
        for (int i = 0; i < actual.Count; ++i)
        {
            AssertSame(expected[i], actual[i], name);
        }
    }

    private static void AssertSameRecord(JsonElement expected, object actual, string name)
    {
        Type type = actual.GetType();
        if (type.Name.StartsWith("MultiDimArray", StringComparison.Ordinal))
        {
            AssertSame(expected.GetProperty("dims"), type.GetProperty("Dims")!.GetValue(actual), name);
            AssertSame(expected.GetProperty("array"), type.GetProperty("Items")!.GetValue(actual), name);
            return;
        }
        if (type.IsValueType)
        {
            AssertSameItems(expected, NumbersOf(actual), name);
            return;
        }
        foreach (JsonProperty field in expected.EnumerateObject())
        {
            string property = string.Concat(field.Name.Split('_').Select(word => char.ToUpperInvariant(word[0]) + word[1..]));
            AssertSame(field.Value, type.GetProperty(property)!.GetValue(actual), name + "." + field.Name);
        }
    }

    private static Array NumbersOf(object namedArray) => namedArray switch
    {
        Vector3 value => Vector3.RrCodec.Numbers(in value).ToArray(),
        Transform value => Transform.RrCodec.Numbers(in value).ToArray(),
        Knots value => Knots.RrCodec.Numbers(in value).ToArray(),
        Twist value => Twist.RrCodec.Numbers(in value).ToArray(),
        Pixel value => Pixel.RrCodec.Numbers(in value).ToArray(),
        Ticks value => Ticks.RrCodec.Numbers(in value).ToArray(),
        _ => throw new ArgumentException(namedArray.GetType().Name),
    };
}
