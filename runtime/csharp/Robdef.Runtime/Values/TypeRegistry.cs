// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Frozen;
using System.Collections.Generic;
using System.Text;

namespace Robdef.Runtime;

/// <summary>
/// The structs, pods and namedarrays that a program knows: where a varvalue that holds one finds
/// its type. Does not change, so any thread may use it.
/// </summary>
public sealed class TypeRegistry
{
    private readonly FrozenDictionary<string, IRecordCodec> _codecs;

    /// <summary>A registry of these types; of two with one name the first counts.</summary>
    public TypeRegistry(IEnumerable<IRecordCodec> codecs)
    {
        ArgumentNullException.ThrowIfNull(codecs);
        var byName = new Dictionary<string, IRecordCodec>(StringComparer.Ordinal);
        foreach (IRecordCodec codec in codecs)
        {
            byName.TryAdd(codec.QualifiedName, codec);
        }
        _codecs = byName.ToFrozenDictionary(StringComparer.Ordinal);
    }

    /// <summary>A registry without types.</summary>
    public static TypeRegistry Empty { get; } = new([]);

    /// <summary>The codec of the type that an element names.</summary>
    /// <exception cref="RobdefException">ServiceError when the program does not know it.</exception>
    internal IRecordCodec Find(scoped in Element element)
    {
        string name = Encoding.UTF8.GetString(element.TypeName);
        if (name.Length == 0 || !name.Contains('.', StringComparison.Ordinal))
        {
            throw element.Error(ErrorCode.InvalidArgument, $"has the type name `{name}`, which is not qualified");
        }
        return _codecs.TryGetValue(name, out IRecordCodec? codec)
            ? codec
            : throw element.Error(ErrorCode.ServiceError, $"is a `{name}`, which this program does not know");
    }
}
