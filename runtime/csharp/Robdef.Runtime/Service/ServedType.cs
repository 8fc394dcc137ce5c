// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>The table of an object's members, made once for its class.</summary>
public sealed unsafe class ServedType
{
    private readonly Lock _lock = new();
    private readonly string _name;
    private ObjectTypeHandle? _handle;

    /// <summary>A table.</summary>
    /// <param name="definition">Where the object is declared.</param>
    /// <param name="name">Its name there.</param>
    /// <param name="members">In the order of their numbers.</param>
    public ServedType(ServiceDefinition definition, string name, IReadOnlyList<ServedMember> members)
    {
        ArgumentNullException.ThrowIfNull(definition);
        Definition = definition;
        _name = name;
        Members = members;
    }

    /// <summary>Where the object is declared.</summary>
    public ServiceDefinition Definition { get; }

    /// <summary>In the order of their numbers.</summary>
    public IReadOnlyList<ServedMember> Members { get; }

    /// <summary>`example.PanTilt`</summary>
    internal string QualifiedName => $"{Definition.Name}.{_name}";

    internal ObjectTypeHandle Handle
    {
        get
        {
            lock (_lock)
            {
                return _handle ??= Make();
            }
        }
    }

    private ObjectTypeHandle Make()
    {
        var texts = new List<nint>();
        RrStr Text(string text)
        {
            byte* copy = (byte*)Marshal.StringToCoTaskMemUTF8(text);
            texts.Add((nint)copy);
            return new RrStr { Data = copy, Size = (nuint)System.Text.Encoding.UTF8.GetByteCount(text) };
        }
        var members = new RrMember[Members.Count];
        for (int i = 0; i < members.Length; ++i)
        {
            ServedMember member = Members[i];
            members[i] = new RrMember
            {
                Name = Text(member.Name),
                Kind = (uint)member.Kind,
                Access = (uint)member.Access,
                ReturnsValue = member.ReturnsValue ? 1u : 0,
                Generator = (uint)member.Generator,
                Index = (uint)member.Index,
                ObjectType = Text(member.ObjectType),
                Memory = new RrMemoryType
                {
                    Element = member.Memory.Element,
                    IsMulti = member.Memory.IsMulti ? 1u : 0,
                    Access = member.Kind == MemberKind.Memory ? (uint)member.Access : 0,
                    TransferSize = member.Memory.TransferSize,
                },
                Check = member.Check is null ? null : &ValueCheck.OnCheck,
                // Never freed: the native table stays as long as a node that has used it, and there is one for each class.
                CheckContext = member.Check is null ? 0 : Context.Of(Tuple.Create(member.Check, Definition.Known.Registry)),
            };
        }
        try
        {
            fixed (RrMember* first = members)
            {
                nint error;
                int status = Functions.rr_object_type_new(Definition.Handle, Text(_name), first, (nuint)members.Length,
                    (nuint)sizeof(RrMember), out nint type, &error);
                Failure.Check(status, error, KnownTypes.None);
                return new ObjectTypeHandle(type);
            }
        }
        finally
        {
            texts.ForEach(Marshal.FreeCoTaskMem);
        }
    }
}
