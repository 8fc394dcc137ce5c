// SPDX-License-Identifier: Apache-2.0
using System;

namespace Robdef.Runtime;

/// <summary>
/// What an element is called by its parent: a name, or a number for items of lists, maps of int32
/// and arrays of pods. Borrows its bytes.
/// </summary>
public readonly ref struct ElementKey
{
    /// <summary>A name, in UTF-8.</summary>
    public ElementKey(ReadOnlySpan<byte> name) => Name = name;

    /// <summary>A number. Message version 2 writes it as decimal text.</summary>
    public ElementKey(int number)
    {
        Number = number;
        IsNumber = true;
    }

    /// <summary>Empty for a number.</summary>
    public ReadOnlySpan<byte> Name { get; }

    /// <summary>0 for a name.</summary>
    public int Number { get; }

    /// <summary>Whether it is a number.</summary>
    public bool IsNumber { get; }

    /// <summary>The element's metadata, normally empty (01, section 8).</summary>
    public ReadOnlySpan<byte> Metadata { get; init; }

    /// <summary>The element's extended field, normally empty; message version 4 only (02, section 5).</summary>
    public ReadOnlySpan<byte> Extended { get; init; }

    /// <summary>A name, as in `"pan"u8`.</summary>
    public static implicit operator ElementKey(ReadOnlySpan<byte> name) => new(name);

    /// <summary>A name, as in `"pan"u8`.</summary>
    public static ElementKey ToElementKey(ReadOnlySpan<byte> name) => new(name);
}
