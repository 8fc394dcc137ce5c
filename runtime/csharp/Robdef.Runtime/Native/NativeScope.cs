// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using System.Text;

namespace Robdef.Runtime.Native;

/// <summary>Texts and arrays of one native call, which do not move and are freed with it.</summary>
internal sealed unsafe class NativeScope : IDisposable
{
    private readonly List<nint> _blocks = [];

    public RrStr Text(string text)
    {
        ArgumentNullException.ThrowIfNull(text);
        int size = Encoding.UTF8.GetByteCount(text);
        byte* data = New<byte>(size);
        Encoding.UTF8.GetBytes(text, new Span<byte>(data, size));
        return new RrStr { Data = data, Size = (nuint)size };
    }

    public RrStr* Texts(IEnumerable<string> texts, out nuint count)
    {
        ArgumentNullException.ThrowIfNull(texts);
        string[] all = [.. texts];
        RrStr* first = New<RrStr>(all.Length);
        for (int i = 0; i < all.Length; ++i)
        {
            first[i] = Text(all[i]);
        }
        count = (nuint)all.Length;
        return first;
    }

    public RrServiceUrls* Services(IEnumerable<IEnumerable<string>> services, out nuint count)
    {
        ArgumentNullException.ThrowIfNull(services);
        IEnumerable<string>[] all = [.. services];
        RrServiceUrls* first = New<RrServiceUrls>(all.Length);
        for (int i = 0; i < all.Length; ++i)
        {
            first[i].Urls = Texts(all[i], out first[i].UrlCount);
        }
        count = (nuint)all.Length;
        return first;
    }

    /// <summary>A map of varvalues as elements; none for null.</summary>
    public RrElements Map(Dictionary<string, VarValue?>? map)
    {
        if (map is null)
        {
            return default;
        }
        using var writer = new ElementWriter(MessageVersion.V4);
        VarValueCodec.StringMap.Write(writer, "value"u8, map);
        byte* data = New<byte>(writer.Length);
        writer.Written.CopyTo(new Span<byte>(data, writer.Length));
        return new RrElements { Data = data, Size = (nuint)writer.Length, Count = (uint)writer.Count, Version = (uint)MessageVersion.V4 };
    }

    /// <summary>All zero.</summary>
    public T* New<T>(int count)
        where T : unmanaged
    {
        void* block = NativeMemory.AllocZeroed((nuint)Math.Max(count, 1), (nuint)sizeof(T));
        _blocks.Add((nint)block);
        return (T*)block;
    }

    public void Dispose()
    {
        foreach (nint block in _blocks)
        {
            NativeMemory.Free((void*)block);
        }
        _blocks.Clear();
    }
}

/// <summary>Copies of what the native runtime has views of.</summary>
internal static unsafe class Copies
{
    public static string[] Texts(RrStr* first, nuint count)
    {
        var texts = new string[checked((int)count)];
        for (int i = 0; i < texts.Length; ++i)
        {
            texts[i] = Failure.Text(first[i]);
        }
        return texts;
    }

    public static Guid Id(RrNodeId id) => new(new ReadOnlySpan<byte>(id.Bytes, 16), bigEndian: true);

    public static RrNodeId Id(Guid id)
    {
        RrNodeId result;
        id.TryWriteBytes(new Span<byte>(result.Bytes, 16), bigEndian: true, out _);
        return result;
    }
}
