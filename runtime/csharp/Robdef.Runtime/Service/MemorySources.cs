// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>A memory of one dimension that an object offers. Called for several clients at once.</summary>
/// <typeparam name="T">One item.</typeparam>
public abstract class ArrayMemorySource<T>
{
    /// <summary>How many items there are.</summary>
    public abstract long Length { get; }

    /// <summary>Reads items that lie inside.</summary>
    public abstract void Read(long position, Span<T> items);

    /// <summary>Writes items that lie inside.</summary>
    public abstract void Write(long position, ReadOnlySpan<T> items);
}

/// <summary>A memory of several dimensions that an object offers. Called for several clients at once.</summary>
/// <typeparam name="T">One item.</typeparam>
public abstract class MultiDimMemorySource<T>
{
    /// <summary>The size in each dimension.</summary>
    public abstract ReadOnlySpan<long> Dims { get; }

    /// <summary>Reads a part that lies inside, the first dimension varying fastest.</summary>
    public abstract void Read(ReadOnlySpan<long> position, ReadOnlySpan<long> count, Span<T> items);

    /// <summary>Writes a part that lies inside, the first dimension varying fastest.</summary>
    public abstract void Write(ReadOnlySpan<long> position, ReadOnlySpan<long> count, ReadOnlySpan<T> items);
}

/// <summary>Memories that are arrays of the program.</summary>
public static class StoredMemory
{
    /// <summary>A memory of one dimension, empty at first.</summary>
    public static StoredArrayMemory<T> Array<T>() => new([]);

    /// <summary>A memory of several dimensions, empty at first.</summary>
    public static StoredMultiDimMemory<T> MultiDim<T>() => new(new MultiDimArray<T>());
}

/// <summary>A memory of one dimension in an array, behind a lock.</summary>
/// <typeparam name="T">One item.</typeparam>
public sealed class StoredArrayMemory<T>(T[] items) : ArrayMemorySource<T>
{
    private readonly Lock _lock = new();
    private T[] _items = items;

    /// <summary>The array, which the memory keeps.</summary>
#pragma warning disable CA1819 // It is what the memory consists of.
    public T[] Items
    {
        get
        {
            lock (_lock)
            {
                return _items;
            }
        }

        set
        {
            lock (_lock)
            {
                _items = value;
            }
        }
    }
#pragma warning restore CA1819

    /// <inheritdoc/>
    public override long Length => Items.Length;

    /// <inheritdoc/>
    public override void Read(long position, Span<T> items)
    {
        lock (_lock)
        {
            _items.AsSpan(checked((int)position), items.Length).CopyTo(items);
        }
    }

    /// <inheritdoc/>
    public override void Write(long position, ReadOnlySpan<T> items)
    {
        lock (_lock)
        {
            items.CopyTo(_items.AsSpan(checked((int)position), items.Length));
        }
    }
}

/// <summary>A memory of several dimensions in an array, behind a lock.</summary>
/// <typeparam name="T">One item.</typeparam>
public sealed class StoredMultiDimMemory<T>(MultiDimArray<T> items) : MultiDimMemorySource<T>
{
    private readonly Lock _lock = new();
    private MultiDimArray<T> _items = items;

    /// <summary>The array, which the memory keeps.</summary>
    public MultiDimArray<T> Items
    {
        get
        {
            lock (_lock)
            {
                return _items;
            }
        }

        set
        {
            lock (_lock)
            {
                _items = value;
            }
        }
    }

    /// <inheritdoc/>
    public override ReadOnlySpan<long> Dims => System.Array.ConvertAll(Items.Dims, static dim => (long)dim);

    /// <inheritdoc/>
    public override void Read(ReadOnlySpan<long> position, ReadOnlySpan<long> count, Span<T> items)
    {
        lock (_lock)
        {
            int next = 0;
            foreach (Run run in RunsOf(position, count))
            {
                _items.Items.AsSpan(run.Begin, run.Length).CopyTo(items[next..]);
                next += run.Length;
            }
        }
    }

    /// <inheritdoc/>
    public override void Write(ReadOnlySpan<long> position, ReadOnlySpan<long> count, ReadOnlySpan<T> items)
    {
        lock (_lock)
        {
            int next = 0;
            foreach (Run run in RunsOf(position, count))
            {
                items.Slice(next, run.Length).CopyTo(_items.Items.AsSpan(run.Begin, run.Length));
                next += run.Length;
            }
        }
    }

    private Runs RunsOf(ReadOnlySpan<long> position, ReadOnlySpan<long> count)
    {
        ulong[] whole = System.Array.ConvertAll(_items.Dims, static dim => (ulong)dim);
        ulong offset = 0;
        for (int i = whole.Length - 1; i >= 0; --i)
        {
            offset = (offset * whole[i]) + (ulong)position[i];
        }
        return new Runs(offset, MemoryMarshal.Cast<long, ulong>(count), whole);
    }
}
