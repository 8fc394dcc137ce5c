// SPDX-License-Identifier: Apache-2.0
using System;
using System.Buffers.Text;
using System.Text;

namespace Robdef.Runtime;

/// <summary>
/// One received message element: a view of bytes that belong to somebody else. Every length was
/// checked against what encloses it when the element was read.
/// </summary>
public readonly ref struct Element
{
    internal Element(MessageVersion version, int depth, TypeRegistry registry)
    {
        Version = version;
        Depth = depth;
        Registry = registry;
    }

    /// <summary>The layout of nested elements.</summary>
    public MessageVersion Version { get; }

    /// <summary>What the parent calls it, in UTF-8; empty when it has a number only.</summary>
    public ReadOnlySpan<byte> Name { get; internal init; }

    /// <summary>Whether it has a number; message version 4 only.</summary>
    public bool HasNumber { get; internal init; }

    /// <summary>The number, or 0.</summary>
    public int Number { get; internal init; }

    /// <summary>Its type: a known one.</summary>
    public ElementType Type { get; internal init; }

    /// <summary>The qualified name of a struct, pod or namedarray, in UTF-8.</summary>
    public ReadOnlySpan<byte> TypeName { get; internal init; }

    /// <summary>Its metadata, normally empty.</summary>
    public ReadOnlySpan<byte> Metadata { get; internal init; }

    /// <summary>Its extended field, normally empty; message version 4 only.</summary>
    public ReadOnlySpan<byte> Extended { get; internal init; }

    /// <summary>Items, nested elements or bytes of a string; as many as the payload holds.</summary>
    public int Count { get; internal init; }

    /// <summary>Packed items or nested elements.</summary>
    public ReadOnlySpan<byte> Payload { get; internal init; }

    /// <summary>Where the types of varvalues are looked up.</summary>
    public TypeRegistry Registry { get; }

    internal int Depth { get; }

    /// <summary>The elements inside. Only for nested types.</summary>
    public ElementReader Nested => new(Payload, Version, Registry, Depth + 1);

    internal FieldReader Fields => new(Nested);

    /// <summary>Throws unless it is of this type: NullValue for a null, else DataTypeMismatch.</summary>
    public void Expect(ElementType type)
    {
        if (Type != type)
        {
            throw Mismatch(type.ToString());
        }
    }

    /// <summary>Throws DataTypeError unless its type name is this one.</summary>
    public void ExpectTypeName(ReadOnlySpan<byte> name)
    {
        if (!TypeName.SequenceEqual(name))
        {
            throw Error(ErrorCode.DataTypeError,
                $"is a `{Encoding.UTF8.GetString(TypeName)}`, not a `{Encoding.UTF8.GetString(name)}`");
        }
    }

    /// <summary>The element with this name inside of a nested one. Throws MessageElementNotFound.</summary>
    public Element Find(scoped ReadOnlySpan<byte> name)
    {
        ElementReader reader = Nested;
        while (reader.TryRead(out Element element))
        {
            if (element.Name.SequenceEqual(name))
            {
                return element;
            }
        }
        throw Error(ErrorCode.MessageElementNotFound, $"has no element `{Encoding.UTF8.GetString(name)}`");
    }

    /// <summary>Its number, or its name read as one. False when it is neither.</summary>
    public bool TryGetNumber(out int number)
    {
        number = Number;
        if (Name.IsEmpty)
        {
            return HasNumber;
        }
        return Utf8Parser.TryParse(Name, out number, out int used) && used == Name.Length;
    }

    /// <summary>An error that says where it is.</summary>
    public RobdefException Error(ErrorCode code, string what)
    {
        string name = Name.IsEmpty && HasNumber ? $"#{Number}" : Encoding.UTF8.GetString(Name);
        return Errors.Of(code, $"the element `{name}` {what}");
    }

    internal RobdefException Mismatch(string wanted) => Type == ElementType.Void
        ? Error(ErrorCode.NullValue, "is null")
        : Error(ErrorCode.DataTypeMismatch, $"is of type {Type}, not {wanted}");
}
