// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.CompilerServices;
using System.Text;

namespace Robdef.Runtime;

/// <summary>Text. Bytes that are not UTF-8 become U+FFFD.</summary>
internal sealed class StringCodec : ValueCodec<string>
{
    public override void Write(ElementWriter writer, scoped in ElementKey key, string value)
    {
        if (value is null)
        {
            throw NullValue.Error(key);
        }
        int begin = writer.BeginElement();
        int count = writer.PrependText(value);
        writer.EndElement(begin, key, ElementType.String, default, count);
    }

    public override string Read(scoped in Element element)
    {
        if (element.Type == ElementType.Void)
        {
            throw element.Error(ErrorCode.DataTypeError, "is null where a string is due");
        }
        element.Expect(ElementType.String);
        return Encoding.UTF8.GetString(element.Payload);
    }
}

/// <summary>An enum travels as an int32.</summary>
internal sealed class EnumCodec<T> : ValueCodec<T>
    where T : unmanaged, Enum
{
    public static EnumCodec<T> Instance { get; } = new();

    public override void Write(ElementWriter writer, scoped in ElementKey key, T value) =>
        ValueCodec.Int32.Write(writer, key, Unsafe.BitCast<T, int>(value));

    public override T Read(scoped in Element element) => Unsafe.BitCast<int, T>(ValueCodec.Int32.Read(element));
}

/// <summary>The type-less element that stands for a null.</summary>
internal static class NullValue
{
    public static void Write(ElementWriter writer, scoped in ElementKey key)
    {
        int begin = writer.BeginElement();
        writer.EndElement(begin, key, ElementType.Void, default, 0);
    }

    public static RobdefException Error(scoped in ElementKey key)
    {
        string name = key.IsNumber ? $"#{key.Number}" : Encoding.UTF8.GetString(key.Name);
        return new NullValueException($"the value `{name}` is null");
    }
}
