// SPDX-License-Identifier: Apache-2.0
using System;
using System.Buffers.Binary;

namespace Robdef.Runtime;

/// <summary>Reads a row of message elements. Borrows the bytes, and allocates nothing.</summary>
public ref struct ElementReader
{
    private readonly MessageVersion _version;
    private readonly TypeRegistry _registry;
    private readonly int _depth;
    private ReadOnlySpan<byte> _rest;

    /// <summary>A reader of packed elements.</summary>
    /// <param name="bytes">The elements, without anything around them.</param>
    /// <param name="version">Their layout.</param>
    /// <param name="registry">Where the types of varvalues are looked up.</param>
    public ElementReader(ReadOnlySpan<byte> bytes, MessageVersion version, TypeRegistry registry)
        : this(bytes, version, registry, 0)
    {
    }

    internal ElementReader(ReadOnlySpan<byte> bytes, MessageVersion version, TypeRegistry registry, int depth)
    {
        _rest = bytes;
        _version = version;
        _registry = registry;
        _depth = depth;
        if (depth > ElementTypes.MaximumDepth)
        {
            throw new DataSerializationException("a received value is nested too deeply");
        }
    }

    /// <summary>The next element; false behind the last.</summary>
    public bool TryRead(out Element element)
    {
        if (_rest.IsEmpty)
        {
            element = default;
            return false;
        }
        element = _version == MessageVersion.V4 ? Read4() : Read2();
        return true;
    }

    /// <summary>The next element. Throws MessageElementNotFound behind the last.</summary>
    public Element Read() => TryRead(out Element element)
        ? element
        : throw new MessageElementNotFoundException("an element is missing");

    private Element Read2()
    {
        var cursor = new Cursor(_rest);
        ReadOnlySpan<byte> bytes = Cut(cursor.UInt32());
        cursor = new Cursor(bytes);
        cursor.Skip(4);
        ReadOnlySpan<byte> name = cursor.Bytes(cursor.UInt16());
        ElementType type = TypeOf(cursor.UInt16());
        ReadOnlySpan<byte> typeName = cursor.Bytes(cursor.UInt16());
        ReadOnlySpan<byte> metadata = cursor.Bytes(cursor.UInt16());
        uint count = cursor.UInt32();
        return new Element(_version, _depth, _registry)
        {
            Name = name,
            Type = type,
            TypeName = typeName,
            Metadata = metadata,
            Count = CountOf(type, count, cursor.Rest),
            Payload = cursor.Rest,
        };
    }

    private Element Read4()
    {
        var cursor = new Cursor(_rest);
        ReadOnlySpan<byte> bytes = Cut(cursor.Unsigned());
        cursor = new Cursor(bytes);
        cursor.Unsigned();
        var flags = (ElementFlags)cursor.Byte();
        ReadOnlySpan<byte> name = flags.HasFlag(ElementFlags.Name) ? cursor.Bytes(cursor.Unsigned()) : default;
        uint nameCode = flags.HasFlag(ElementFlags.NameCode) ? cursor.Unsigned() : 0;
        int number = flags.HasFlag(ElementFlags.Number) ? cursor.Signed() : 0;
        ElementType type = TypeOf(cursor.UInt16());
        ReadOnlySpan<byte> typeName = flags.HasFlag(ElementFlags.TypeName) ? cursor.Bytes(cursor.Unsigned()) : default;
        uint typeNameCode = flags.HasFlag(ElementFlags.TypeNameCode) ? cursor.Unsigned() : 0;
        // Codes are resolved by the native runtime; 0 is the empty text (02, section 6).
        if ((nameCode != 0 && name.IsEmpty) || (typeNameCode != 0 && typeName.IsEmpty))
        {
            throw Broken("has a name of a string table");
        }
        ReadOnlySpan<byte> metadata = flags.HasFlag(ElementFlags.Metadata) ? cursor.Bytes(cursor.Unsigned()) : default;
        ReadOnlySpan<byte> extended = flags.HasFlag(ElementFlags.Extended) ? cursor.Bytes(cursor.Unsigned()) : default;
        uint count = cursor.Unsigned();
        return new Element(_version, _depth, _registry)
        {
            Name = name,
            HasNumber = flags.HasFlag(ElementFlags.Number),
            Number = number,
            Type = type,
            TypeName = typeName,
            Metadata = metadata,
            Extended = extended,
            Count = CountOf(type, count, cursor.Rest),
            Payload = cursor.Rest,
        };
    }

    private ReadOnlySpan<byte> Cut(uint size)
    {
        if (size < 4 || size > (uint)_rest.Length)
        {
            throw Broken("has a size that is not inside its parent");
        }
        ReadOnlySpan<byte> bytes = _rest[..(int)size];
        _rest = _rest[(int)size..];
        return bytes;
    }

    private static ElementType TypeOf(ushort number) =>
        ElementTypes.IsKnown((ElementType)number) ? (ElementType)number : throw Broken($"has the unknown type {number}");

    /// <summary>Payload and count must fit: nested ones are counted here, packed ones measured.</summary>
    private readonly int CountOf(ElementType type, uint count, ReadOnlySpan<byte> payload)
    {
        if (type == ElementType.Void)
        {
            return payload.IsEmpty ? 0 : throw Broken("is null and has content");
        }
        if (!ElementTypes.IsNested(type))
        {
            return count * (ulong)ElementTypes.SizeOf(type) == (ulong)payload.Length
                ? (int)count
                : throw Broken($"has {payload.Length} bytes for {count} items");
        }
        int smallest = _version == MessageVersion.V4 ? 5 : 16;
        return count <= (uint)(payload.Length / smallest) && (count != 0 || payload.IsEmpty)
            ? (int)count
            : throw Broken($"has {payload.Length} bytes for {count} elements");
    }

    private static DataSerializationException Broken(string what) =>
        new DataSerializationException("a received element " + what);

    /// <summary>Takes fields from the front.</summary>
    private ref struct Cursor(ReadOnlySpan<byte> bytes)
    {
        public ReadOnlySpan<byte> Rest { get; private set; } = bytes;

        public ReadOnlySpan<byte> Bytes(uint size)
        {
            if (size > (uint)Rest.Length)
            {
                throw Broken("ends too early");
            }
            ReadOnlySpan<byte> result = Rest[..(int)size];
            Rest = Rest[(int)size..];
            return result;
        }

        public void Skip(uint size) => Bytes(size);

        public byte Byte() => Bytes(1)[0];

        public ushort UInt16() => BinaryPrimitives.ReadUInt16LittleEndian(Bytes(2));

        public uint UInt32() => BinaryPrimitives.ReadUInt32LittleEndian(Bytes(4));

        public uint Unsigned() => Byte() switch
        {
            253 => UInt16(),
            254 => UInt32(),
            255 => throw Broken("has a number of 64 bits where there is none"),
            byte value => value,
        };

        public int Signed() => (sbyte)Byte() switch
        {
            125 => (short)UInt16(),
            126 => (int)UInt32(),
            127 => throw Broken("has a number of 64 bits where there is none"),
            sbyte value => value,
        };
    }
}
