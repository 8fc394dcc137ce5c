// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>Items that lie behind each other.</summary>
internal readonly record struct Run(int Begin, int Length);

/// <summary>The runs of a block inside a larger array, the first dimension varying fastest.</summary>
internal ref struct Runs
{
    private readonly ReadOnlySpan<ulong> _count;
    private readonly ReadOnlySpan<ulong> _whole;
    private readonly ulong _offset;
    private readonly int _runs;
    private int _next;

    public Runs(ulong offset, ReadOnlySpan<ulong> count, ReadOnlySpan<ulong> whole)
    {
        _offset = offset;
        _count = count;
        _whole = whole;
        _runs = count[0] == 0 ? 0 : Product(count[1..]);
    }

    public Run Current { get; private set; }

    public static int Product(ReadOnlySpan<ulong> count)
    {
        ulong product = 1;
        foreach (ulong one in count)
        {
            product = checked(product * one);
        }
        return checked((int)product);
    }

    public readonly Runs GetEnumerator() => this;

    public bool MoveNext()
    {
        if (_next == _runs)
        {
            return false;
        }
        ulong rest = (ulong)_next++;
        ulong begin = _offset;
        ulong stride = _whole[0];
        for (int i = 1; i < _count.Length; ++i)
        {
            begin += rest % _count[i] * stride;
            rest /= _count[i];
            stride *= _whole[i];
        }
        Current = new Run(checked((int)begin), (int)_count[0]);
        return true;
    }
}
