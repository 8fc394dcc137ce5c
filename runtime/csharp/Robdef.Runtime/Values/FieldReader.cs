// SPDX-License-Identifier: Apache-2.0
using System;
using System.Text;

namespace Robdef.Runtime;

/// <summary>
/// Reads elements by their names: fields of a struct or pod, arguments of a call. Quickest in the
/// order in which they were written, which is that of the definition.
/// </summary>
public ref struct FieldReader
{
    private readonly ElementReader _all;
    private ElementReader _inOrder;
    private bool _isInOrder = true;

    internal FieldReader(ElementReader all)
    {
        _all = all;
        _inOrder = all;
    }

    internal FieldReader(ReadOnlySpan<byte> bytes, MessageVersion version, TypeRegistry registry)
        : this(new ElementReader(bytes, version, registry))
    {
    }

    /// <summary>The value of a field. Of two with one name the first counts. Throws MessageElementNotFound.</summary>
    public T Read<T>(ValueCodec<T> codec, scoped ReadOnlySpan<byte> name)
    {
        if (_isInOrder && _inOrder.TryRead(out Element next) && next.Name.SequenceEqual(name))
        {
            return codec.Read(next);
        }
        _isInOrder = false;
        ElementReader reader = _all;
        while (reader.TryRead(out Element element))
        {
            if (element.Name.SequenceEqual(name))
            {
                return codec.Read(element);
            }
        }
        throw new MessageElementNotFoundException($"there is no element `{Encoding.UTF8.GetString(name)}`");
    }
}
