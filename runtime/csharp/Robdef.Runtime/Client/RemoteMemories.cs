// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>A memory of one dimension of an object on another node.</summary>
/// <typeparam name="T">One item.</typeparam>
public sealed class ArrayMemory<T>
{
    private readonly MemoryTransfer<T> _transfer;

    /// <summary>The memory of a stub.</summary>
    public ArrayMemory(Stub stub, string member, MemberAccess access, ItemCodec<T> codec) =>
        _transfer = new MemoryTransfer<T>(stub, member, access, codec, isMulti: false);

    /// <summary>Asks how many items there are.</summary>
    public long GetLength(CancellationToken cancel = default) => (long)_transfer.Ask("Length", cancel);

    /// <summary>Asks how many items there are.</summary>
    public async Task<long> GetLengthAsync(CancellationToken cancel = default) =>
        (long)await _transfer.AskAsync("Length", cancel).ConfigureAwait(false);

    /// <summary>Reads as many items as the span has, from a position on, in as many requests as it takes.</summary>
    public void Read(long position, Span<T> items) => _transfer.Read([(ulong)position], [(ulong)items.Length], items);

    /// <summary>Writes items to a position.</summary>
    public void Write(long position, ReadOnlySpan<T> items) => _transfer.Write([(ulong)position], [(ulong)items.Length], items);

    /// <summary>Reads as many items as there is room for. Numbers: cancelled between two requests; pods and namedarrays: before it begins, in a thread of the pool.</summary>
    public Task ReadAsync(long position, Memory<T> items, CancellationToken cancel = default) =>
        _transfer.ReadAsync([(ulong)position], [(ulong)items.Length], items, cancel);

    /// <summary>Writes items to a position. Numbers: cancelled between two requests; pods and namedarrays: before it begins, in a thread of the pool.</summary>
    public Task WriteAsync(long position, ReadOnlyMemory<T> items, CancellationToken cancel = default) =>
        _transfer.WriteAsync([(ulong)position], [(ulong)items.Length], items, cancel);
}

/// <summary>A memory of several dimensions of an object on another node. The first dimension varies fastest.</summary>
/// <typeparam name="T">One item.</typeparam>
public sealed class MultiDimMemory<T>
{
    private readonly MemoryTransfer<T> _transfer;

    /// <summary>The memory of a stub.</summary>
    public MultiDimMemory(Stub stub, string member, MemberAccess access, ItemCodec<T> codec) =>
        _transfer = new MemoryTransfer<T>(stub, member, access, codec, isMulti: true);

    /// <summary>Asks for the size in each dimension.</summary>
    public long[] GetDims(CancellationToken cancel = default) => Array.ConvertAll(_transfer.AskDims(cancel), static dim => (long)dim);

    /// <summary>Asks for the size in each dimension.</summary>
    public async Task<long[]> GetDimsAsync(CancellationToken cancel = default) =>
        Array.ConvertAll(await _transfer.AskDimsAsync(cancel).ConfigureAwait(false), static dim => (long)dim);

    /// <summary>Asks how many dimensions there are.</summary>
    public long GetDimCount(CancellationToken cancel = default) => (long)_transfer.Ask("DimCount", cancel);

    /// <summary>Asks how many dimensions there are.</summary>
    public async Task<long> GetDimCountAsync(CancellationToken cancel = default) =>
        (long)await _transfer.AskAsync("DimCount", cancel).ConfigureAwait(false);

    /// <summary>Reads a part into a span that has exactly its items.</summary>
    public void Read(ReadOnlySpan<long> position, ReadOnlySpan<long> count, Span<T> items) =>
        _transfer.Read(MemoryMarshal.Cast<long, ulong>(position), MemoryMarshal.Cast<long, ulong>(count), items);

    /// <summary>Writes a part from a span that has exactly its items.</summary>
    public void Write(ReadOnlySpan<long> position, ReadOnlySpan<long> count, ReadOnlySpan<T> items) =>
        _transfer.Write(MemoryMarshal.Cast<long, ulong>(position), MemoryMarshal.Cast<long, ulong>(count), items);

    /// <summary>Reads a part. Numbers: cancelled between two requests; pods and namedarrays: before it begins, in a thread of the pool.</summary>
    public Task ReadAsync(long[] position, long[] count, Memory<T> items, CancellationToken cancel = default) =>
        _transfer.ReadAsync(Numbers(position), Numbers(count), items, cancel);

    /// <summary>Writes a part. Numbers: cancelled between two requests; pods and namedarrays: before it begins, in a thread of the pool.</summary>
    public Task WriteAsync(long[] position, long[] count, ReadOnlyMemory<T> items, CancellationToken cancel = default) =>
        _transfer.WriteAsync(Numbers(position), Numbers(count), items, cancel);

    private static ulong[] Numbers(long[] numbers) => Array.ConvertAll(numbers, static number => (ulong)number);
}
