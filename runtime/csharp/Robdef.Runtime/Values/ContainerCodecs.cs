// SPDX-License-Identifier: Apache-2.0
using System;
using System.Buffers;
using System.Collections.Generic;
using System.Text;

namespace Robdef.Runtime;

/// <summary>A list: items are numbered from 0.</summary>
internal sealed class ListCodec<T>(ValueCodec<T> item) : ValueCodec<List<T>?>
{
    public override void Write(ElementWriter writer, scoped in ElementKey key, List<T>? value)
    {
        if (value is null)
        {
            NullValue.Write(writer, key);
            return;
        }
        int begin = writer.BeginElement();
        for (int i = value.Count - 1; i >= 0; --i)
        {
            item.Write(writer, new ElementKey(i), value[i]);
        }
        writer.EndElement(begin, key, ElementType.List, default, value.Count);
    }

    public override List<T>? Read(scoped in Element element)
    {
        if (element.Type == ElementType.Void)
        {
            return null;
        }
        element.Expect(ElementType.List);
        var list = new List<T>(element.Count);
        ElementReader reader = element.Nested;
        while (reader.TryRead(out Element nested))
        {
            if (!nested.TryGetNumber(out int number) || number != list.Count)
            {
                throw nested.Error(ErrorCode.DataTypeError, $"stands in a list at place {list.Count}");
            }
            list.Add(item.Read(nested));
        }
        return list;
    }
}

/// <summary>A map of int32, sent in the order of its keys. Of a key that arrives twice the first counts.</summary>
internal sealed class Int32MapCodec<T>(ValueCodec<T> item) : ValueCodec<Dictionary<int, T>?>
{
    public override void Write(ElementWriter writer, scoped in ElementKey key, Dictionary<int, T>? value)
    {
        if (value is null)
        {
            NullValue.Write(writer, key);
            return;
        }
        int begin = writer.BeginElement();
        int[] keys = [.. value.Keys];
        Array.Sort(keys);
        for (int i = keys.Length - 1; i >= 0; --i)
        {
            item.Write(writer, new ElementKey(keys[i]), value[keys[i]]);
        }
        writer.EndElement(begin, key, ElementType.Int32Map, default, keys.Length);
    }

    public override Dictionary<int, T>? Read(scoped in Element element)
    {
        if (element.Type == ElementType.Void)
        {
            return null;
        }
        element.Expect(ElementType.Int32Map);
        var map = new Dictionary<int, T>(element.Count);
        ElementReader reader = element.Nested;
        while (reader.TryRead(out Element nested))
        {
            if (!nested.TryGetNumber(out int number))
            {
                throw nested.Error(ErrorCode.DataTypeError, "is no key of a map of int32");
            }
            map.TryAdd(number, item.Read(nested));
        }
        return map;
    }
}

/// <summary>A map of string, sent in the order of its keys' bytes. Of a key that arrives twice the first counts.</summary>
internal sealed class StringMapCodec<T>(ValueCodec<T> item) : ValueCodec<Dictionary<string, T>?>
{
    public override void Write(ElementWriter writer, scoped in ElementKey key, Dictionary<string, T>? value)
    {
        if (value is null)
        {
            NullValue.Write(writer, key);
            return;
        }
        int begin = writer.BeginElement();
        string[] keys = [.. value.Keys];
        Array.Sort(keys, CompareBytes);
        for (int i = keys.Length - 1; i >= 0; --i)
        {
            WriteItem(writer, keys[i], value[keys[i]]);
        }
        writer.EndElement(begin, key, ElementType.StringMap, default, keys.Length);
    }

    public override Dictionary<string, T>? Read(scoped in Element element)
    {
        if (element.Type == ElementType.Void)
        {
            return null;
        }
        element.Expect(ElementType.StringMap);
        var map = new Dictionary<string, T>(element.Count, StringComparer.Ordinal);
        ElementReader reader = element.Nested;
        while (reader.TryRead(out Element nested))
        {
            if (nested.HasNumber && nested.Name.IsEmpty)
            {
                throw nested.Error(ErrorCode.DataTypeError, "is no key of a map of string");
            }
            map.TryAdd(Encoding.UTF8.GetString(nested.Name), item.Read(nested));
        }
        return map;
    }

    private void WriteItem(ElementWriter writer, string key, T value)
    {
        const int OnStack = 256;
        int size = Encoding.UTF8.GetMaxByteCount(key.Length);
        byte[]? rented = size > OnStack ? ArrayPool<byte>.Shared.Rent(size) : null;
        Span<byte> name = rented ?? stackalloc byte[OnStack];
        name = name[..Encoding.UTF8.GetBytes(key, name)];
        item.Write(writer, new ElementKey(name), value);
        if (rented is not null)
        {
            ArrayPool<byte>.Shared.Return(rented);
        }
    }

    /// <summary>UTF-8 sorts as code points do, UTF-16 does not where surrogates meet the characters above them.</summary>
    private static int CompareBytes(string a, string b)
    {
        int length = Math.Min(a.Length, b.Length);
        for (int i = 0; i < length; ++i)
        {
            if (a[i] != b[i])
            {
                bool isSurrogateA = char.IsSurrogate(a[i]);
                bool isSurrogateB = char.IsSurrogate(b[i]);
                return isSurrogateA != isSurrogateB ? isSurrogateA.CompareTo(isSurrogateB) : a[i].CompareTo(b[i]);
            }
        }
        return a.Length.CompareTo(b.Length);
    }
}
