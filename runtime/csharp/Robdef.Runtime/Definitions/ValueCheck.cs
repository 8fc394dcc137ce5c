// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>
/// Looks at what clients send through a pipe or wire when it comes, so that what is not of the member's type is refused
/// then, and not found wrong where the program reads it.
/// </summary>
public abstract unsafe class ValueCheck
{
    /// <summary>Values must be such as this codec reads.</summary>
    public static ValueCheck Of<T>(ValueCodec<T> codec)
    {
        ArgumentNullException.ThrowIfNull(codec);
        return new ValueCheck<T>(codec);
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    internal static int OnCheck(nint context, RrElements* value)
    {
        try
        {
            (ValueCheck check, TypeRegistry registry) = Context.Get<Tuple<ValueCheck, TypeRegistry>>(context);
            check.Read(*value, registry);
            return 0;
        }
        catch (RobdefException error)
        {
            return (int)error.Code;
        }
        catch (Exception)
        {
            // It must not go on into native code.
            return (int)ErrorCode.DataTypeError;
        }
    }

    private protected abstract void Read(RrElements value, TypeRegistry registry);
}

internal sealed class ValueCheck<T>(ValueCodec<T> codec) : ValueCheck
{
    private protected override void Read(RrElements value, TypeRegistry registry)
    {
        Element element = Elements.Reader(value, registry).Read();
        codec.Check(element);
    }
}
