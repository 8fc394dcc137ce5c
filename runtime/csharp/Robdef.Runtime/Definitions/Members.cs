// SPDX-License-Identifier: Apache-2.0
using System;

namespace Robdef.Runtime;

/// <summary>Numbers of what generated code expects of this runtime; code for another one does not compile.</summary>
public static class StubApi
{
    /// <summary>The interface of this runtime.</summary>
    public const int Version2 = 2;
}

/// <summary>The kinds of members, by the numbers of rr.h.</summary>
public enum MemberKind
{
#pragma warning disable CS1591 // The words of the language.
    /// <summary>A value that clients get and set.</summary>
    Property = 0,
    /// <summary>What clients call.</summary>
    Function = 1,
    /// <summary>What the service notifies clients of.</summary>
    Event = 2,
    /// <summary>A reference to another object.</summary>
    ObjRef = 3,
    /// <summary>Packets in order, both ways.</summary>
    Pipe = 4,
    /// <summary>What the service calls at one client.</summary>
    Callback = 5,
    /// <summary>A value of which only the newest counts.</summary>
    Wire = 6,
    /// <summary>An array that is read and written in parts.</summary>
    Memory = 7,
#pragma warning restore CS1591
}

/// <summary>The modifiers of a member.</summary>
[Flags]
public enum MemberAccess
{
#pragma warning disable CS1591 // The words of the language.
    /// <summary>No modifier.</summary>
    None = 0,
    /// <summary>Clients get or receive only.</summary>
    ReadOnly = 1,
    /// <summary>Clients set or send only.</summary>
    WriteOnly = 2,
    /// <summary>Pipe, wire: packets may be lost or overtake each other.</summary>
    Unreliable = 4,
    /// <summary>May be used while another user has locked the object.</summary>
    NoLock = 8,
    /// <summary>The same for reading only.</summary>
    NoLockRead = 16,
    /// <summary>Each client has its own value.</summary>
    PerClient = 32,
    /// <summary>Sent before other messages that wait.</summary>
    Urgent = 64,
#pragma warning restore CS1591
}

/// <summary>How a function gives a generator.</summary>
public enum GeneratorForm
{
    /// <summary>It gives none.</summary>
    None = 0,

    /// <summary>One that gives values.</summary>
    Returns = 1,

    /// <summary>One that takes values.</summary>
    Takes = 2,

    /// <summary>One that does both.</summary>
    Both = 3,
}

/// <summary>How the objects of an objref are told apart.</summary>
public enum IndexForm
{
    /// <summary>There is one.</summary>
    None = 0,

    /// <summary>By number.</summary>
    Int32 = 1,

    /// <summary>By name.</summary>
    String = 2,
}

/// <summary>The index of an objref: nothing, a number or a text.</summary>
public readonly record struct ObjectIndex
{
    private ObjectIndex(IndexForm form, int number, string text)
    {
        Form = form;
        Number = number;
        Text = text;
    }

    /// <summary>No index.</summary>
    public static ObjectIndex None => default;

    internal IndexForm Form { get; }

    internal int Number { get; }

    internal string? Text { get; }

    /// <summary>A number.</summary>
    public static implicit operator ObjectIndex(int number) => FromInt32(number);

    /// <summary>A text, as it is.</summary>
    public static implicit operator ObjectIndex(string text) => FromString(text);

    /// <summary>A number.</summary>
    public static ObjectIndex FromInt32(int number) => new(IndexForm.Int32, number, "");

    /// <summary>A text, as it is.</summary>
    public static ObjectIndex FromString(string text) => new(IndexForm.String, 0, text);
}

/// <summary>What a memory is of.</summary>
public readonly record struct MemoryType
{
    internal uint Element { get; init; }

    internal bool IsMulti { get; init; }

    internal uint TransferSize { get; init; }

    /// <summary>A memory of these items, of one or several dimensions.</summary>
    public static MemoryType Of<T>(ItemCodec<T> item, bool isMulti)
    {
        ArgumentNullException.ThrowIfNull(item);
        return new() { Element = (uint)item.ArrayType, IsMulti = isMulti, TransferSize = item.TransferSize };
    }
}

/// <summary>A member of an object that is served.</summary>
/// <param name="Name">As in the definition.</param>
/// <param name="Kind">Its kind.</param>
/// <param name="Access">Its modifiers.</param>
public sealed record ServedMember(string Name, MemberKind Kind, MemberAccess Access)
{
    /// <summary>Function, callback: it is not void.</summary>
    public bool ReturnsValue { get; init; }

    /// <summary>Function: how it gives a generator.</summary>
    public GeneratorForm Generator { get; init; }

    /// <summary>Objref: its index.</summary>
    public IndexForm Index { get; init; }

    /// <summary>Objref: the qualified type; empty for varobject.</summary>
    public string ObjectType { get; init; } = "";

    /// <summary>Memory: what it is of.</summary>
    public MemoryType Memory { get; init; }

    /// <summary>Pipe, wire: what values that clients send must be.</summary>
    public ValueCheck? Check { get; init; }
}
