// SPDX-License-Identifier: Apache-2.0
using System;
using System.Buffers;
using System.Buffers.Binary;
using System.Buffers.Text;
using System.Text;

namespace Robdef.Runtime;

/// <summary>
/// Writes message elements from the last to the first, each from its payload to its size: an
/// element begins with its size, which in message version 4 has a length of its own, so this way
/// every byte is written once and nothing is measured before. What is added last stands first.
/// Not for several threads at once.
/// </summary>
public sealed partial class ElementWriter : IDisposable
{
    private const int FirstCapacity = 512;
    private const int LongestName = ushort.MaxValue;

    private byte[] _buffer;
    private int _begin;
    private int _depth;

    /// <summary>An empty writer.</summary>
    public ElementWriter(MessageVersion version)
    {
        if (!BitConverter.IsLittleEndian)
        {
            throw new PlatformNotSupportedException("values are little-endian, and so must be the machine");
        }
        Version = version;
        _buffer = ArrayPool<byte>.Shared.Rent(FirstCapacity);
        _begin = _buffer.Length;
    }

    /// <summary>The layout that is written.</summary>
    public MessageVersion Version { get; private set; }

    /// <summary>Bytes written so far; the place to give to <see cref="EndElement"/> before a payload begins.</summary>
    public int Length => _buffer.Length - _begin;

    /// <summary>Top-level elements written so far.</summary>
    public int Count { get; private set; }

    /// <summary>All that was written. Valid until the next call that writes.</summary>
    public ReadOnlySpan<byte> Written => _buffer.AsSpan(_begin);

    /// <summary>The same, for those that need it for longer than a call.</summary>
    public ReadOnlyMemory<byte> WrittenMemory => _buffer.AsMemory(_begin);

    /// <summary>Forgets all that was written, and goes on in the other layout if it is another.</summary>
    public void Reset(MessageVersion version)
    {
        Version = version;
        _begin = _buffer.Length;
        _depth = 0;
        Count = 0;
        ForgetReferences();
    }

    /// <summary>Gives the memory back.</summary>
    public void Dispose()
    {
        ForgetReferences();
        ArrayPool<byte>.Shared.Return(_buffer);
        _buffer = [];
        _begin = 0;
    }

    /// <summary>Begins a nested payload: what is written until <see cref="EndElement"/> is inside of the element.</summary>
    /// <returns>The place to give to <see cref="EndElement"/>.</returns>
    public int BeginElement()
    {
        if (++_depth > ElementTypes.MaximumDepth)
        {
            throw new DataSerializationException("a value is nested too deeply to be sent");
        }
        return Length;
    }

    /// <summary>Puts an element's head in front of its payload.</summary>
    /// <param name="begin">What <see cref="BeginElement"/> gave.</param>
    /// <param name="key">What its parent calls it.</param>
    /// <param name="type">Its type.</param>
    /// <param name="typeName">The qualified name of a struct, pod or namedarray, in UTF-8; else empty.</param>
    /// <param name="count">Items, nested elements or bytes of a string.</param>
    public void EndElement(int begin, scoped in ElementKey key, ElementType type, scoped ReadOnlySpan<byte> typeName, int count)
    {
        if (Version == MessageVersion.V2 && (key.Name.Length > LongestName || key.Metadata.Length > LongestName))
        {
            throw new ProtocolException("the name of an element is longer than 65535 bytes");
        }
        if (Version == MessageVersion.V4)
        {
            PrependHead4(begin, key, type, typeName, count);
        }
        else
        {
            PrependHead2(begin, key, type, typeName, count);
        }
        if (--_depth == 0)
        {
            Count++;
        }
    }

    /// <summary>Puts bytes in front of what is there.</summary>
    public void Prepend(scoped ReadOnlySpan<byte> bytes) => bytes.CopyTo(Reserve(bytes.Length));

    /// <summary>Puts room for bytes in front of what is there, to be filled at once.</summary>
    public Span<byte> Reserve(int size)
    {
        if (_begin < size)
        {
            Grow(size);
        }
        _begin -= size;
        return _buffer.AsSpan(_begin, size);
    }

    /// <summary>Puts text in front of what is there, as UTF-8.</summary>
    /// <returns>How many bytes it has.</returns>
    public int PrependText(string text)
    {
        int size = Encoding.UTF8.GetByteCount(text);
        Encoding.UTF8.GetBytes(text, Reserve(size));
        return size;
    }

    private void PrependHead2(int begin, in ElementKey key, ElementType type, ReadOnlySpan<byte> typeName, int count)
    {
        BinaryPrimitives.WriteInt32LittleEndian(Reserve(4), count);
        PrependName2(key.Metadata);
        PrependName2(typeName);
        BinaryPrimitives.WriteUInt16LittleEndian(Reserve(2), (ushort)type);
        if (key.IsNumber)
        {
            Span<byte> digits = stackalloc byte[11];
            Utf8Formatter.TryFormat(key.Number, digits, out int length);
            PrependName2(digits[..length]);
        }
        else
        {
            PrependName2(key.Name);
        }
        int size = Length - begin + 4;
        BinaryPrimitives.WriteInt32LittleEndian(Reserve(4), size);
    }

    private void PrependHead4(int begin, in ElementKey key, ElementType type, ReadOnlySpan<byte> typeName, int count)
    {
        ElementFlags flags = key.IsNumber ? ElementFlags.Number : ElementFlags.Name;
        PrependUnsigned((uint)count);
        if (!key.Extended.IsEmpty)
        {
            flags |= ElementFlags.Extended;
            PrependName4(key.Extended);
        }
        if (!key.Metadata.IsEmpty)
        {
            flags |= ElementFlags.Metadata;
            PrependName4(key.Metadata);
        }
        if (!typeName.IsEmpty)
        {
            flags |= ElementFlags.TypeName;
            PrependName4(typeName);
        }
        BinaryPrimitives.WriteUInt16LittleEndian(Reserve(2), (ushort)type);
        if (key.IsNumber)
        {
            PrependSigned(key.Number);
        }
        else
        {
            PrependName4(key.Name);
        }
        Reserve(1)[0] = (byte)flags;
        int rest = Length - begin;
        // The size counts its own bytes (02, section 1.3).
        PrependUnsigned((uint)(rest + (rest <= 251 ? 1 : rest <= 65532 ? 3 : 5)));
    }

    private void PrependName2(ReadOnlySpan<byte> name)
    {
        Prepend(name);
        BinaryPrimitives.WriteUInt16LittleEndian(Reserve(2), (ushort)name.Length);
    }

    private void PrependName4(ReadOnlySpan<byte> name)
    {
        Prepend(name);
        PrependUnsigned((uint)name.Length);
    }

    private void PrependUnsigned(uint value)
    {
        if (value <= 252)
        {
            Reserve(1)[0] = (byte)value;
        }
        else if (value <= ushort.MaxValue)
        {
            Span<byte> bytes = Reserve(3);
            bytes[0] = 253;
            BinaryPrimitives.WriteUInt16LittleEndian(bytes[1..], (ushort)value);
        }
        else
        {
            Span<byte> bytes = Reserve(5);
            bytes[0] = 254;
            BinaryPrimitives.WriteUInt32LittleEndian(bytes[1..], value);
        }
    }

    private void PrependSigned(int value)
    {
        if (value is >= -128 and <= 124)
        {
            Reserve(1)[0] = (byte)value;
        }
        else if (value is >= short.MinValue and <= short.MaxValue)
        {
            Span<byte> bytes = Reserve(3);
            bytes[0] = 125;
            BinaryPrimitives.WriteInt16LittleEndian(bytes[1..], (short)value);
        }
        else
        {
            Span<byte> bytes = Reserve(5);
            bytes[0] = 126;
            BinaryPrimitives.WriteInt32LittleEndian(bytes[1..], value);
        }
    }

    private void Grow(int size)
    {
        int length = Length;
        long wanted = Math.Max(2L * _buffer.Length, (long)length + size);
        if (wanted > Array.MaxLength)
        {
            throw new BufferLimitViolationException("a value is too large to be sent");
        }
        byte[] larger = ArrayPool<byte>.Shared.Rent((int)wanted);
        Written.CopyTo(larger.AsSpan(larger.Length - length));
        ArrayPool<byte>.Shared.Return(_buffer);
        _buffer = larger;
        _begin = larger.Length - length;
    }
}
