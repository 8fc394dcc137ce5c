// SPDX-License-Identifier: Apache-2.0
using System;
using System.Buffers.Binary;
using System.Collections.Generic;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;

namespace Robdef.Runtime;

/// <summary>
/// Large arrays that stay where they are: what is written goes into native code at once, which sends their items from there.
/// In their place stands what rr.h calls a reference.
/// </summary>
public sealed partial class ElementWriter
{
    // As the native runtime: smaller arrays are copied, which costs less than a piece of their own.
    private const int LeastReferred = 16 * 1024;
    private const int ReferenceSize = 24;

    private readonly List<Reference> _references = [];

    /// <summary>Whether what is written goes into native code, and nowhere else.</summary>
    internal bool MayRefer { get; init; }

    /// <summary>Whether something of it lies elsewhere.</summary>
    internal bool HasReferences => _references.Count != 0;

    /// <summary>Puts an element for an array of packed items in front of what is there: the array itself, or a reference.</summary>
    /// <param name="key">What its parent calls it.</param>
    /// <param name="type">Of a number.</param>
    /// <param name="items">Numbers, or structs of nothing but such numbers.</param>
    /// <param name="count">Of the numbers.</param>
    internal void PrependArray<T>(scoped in ElementKey key, ElementType type, T[] items, int count)
        where T : unmanaged
    {
        int begin = BeginElement();
        if (!MayRefer || (long)items.Length * Unsafe.SizeOf<T>() < LeastReferred || !key.Metadata.IsEmpty)
        {
            Packed.Write<T>(this, items);
            EndElement(begin, key, type, default, count);
            return;
        }
        Span<byte> reference = Reserve(ReferenceSize);
        reference[..8].Clear();
        BinaryPrimitives.WriteInt64LittleEndian(reference[8..], count);
        BinaryPrimitives.WriteInt64LittleEndian(reference[16..], (long)type);
        _references.Add(new Reference(items, Length));
        ElementKey marked = key.IsNumber
            ? new ElementKey(key.Number) { Metadata = "rr.array"u8, Extended = key.Extended }
            : new ElementKey(key.Name) { Metadata = "rr.array"u8, Extended = key.Extended };
        EndElement(begin, marked, ElementType.UInt8, default, ReferenceSize);
    }

    /// <summary>Says where the arrays are, which do not move until what is written is forgotten.</summary>
    internal void PinReferences()
    {
        foreach (ref Reference reference in CollectionsMarshal.AsSpan(_references))
        {
            reference.Pin();
            BinaryPrimitives.WriteInt64LittleEndian(_buffer.AsSpan(_buffer.Length - reference.Place), reference.Address);
        }
    }

    private void ForgetReferences()
    {
        foreach (ref Reference reference in CollectionsMarshal.AsSpan(_references))
        {
            reference.Unpin();
        }
        _references.Clear();
    }

    /// <summary>An array, and how far from the end its reference begins.</summary>
    private struct Reference(Array items, int place)
    {
        private GCHandle _pin;

        public readonly int Place => place;

        public readonly nint Address => _pin.AddrOfPinnedObject();

        public void Pin()
        {
            if (!_pin.IsAllocated)
            {
                _pin = GCHandle.Alloc(items, GCHandleType.Pinned);
            }
        }

        public void Unpin()
        {
            if (_pin.IsAllocated)
            {
                _pin.Free();
            }
        }
    }
}
