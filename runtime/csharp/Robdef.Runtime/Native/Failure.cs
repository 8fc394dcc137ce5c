// SPDX-License-Identifier: Apache-2.0
using System;
using System.Text;

namespace Robdef.Runtime.Native;

/// <summary>Errors as they cross the border.</summary>
internal static unsafe class Failure
{
    /// <summary>Throws for anything but a success; releases the error.</summary>
    public static void Check(int status, nint error, KnownTypes types)
    {
        if (status != 0)
        {
            throw Take(status, error, types);
        }
    }

    /// <summary>The exception for an error, which is released.</summary>
    public static RobdefException Take(int status, nint error, KnownTypes types)
    {
        if (error == 0)
        {
            var code = (ErrorCode)status;
            return Errors.Of(code, code.ToString());
        }
        try
        {
            var info = new RrErrorInfo { Size = (nuint)sizeof(RrErrorInfo) };
            Functions.rr_error_read(error, &info);
            return Read(info, types);
        }
        finally
        {
            Functions.rr_error_release(error);
        }
    }

    public static RobdefException Read(in RrErrorInfo info, KnownTypes types)
    {
        VarValue? parameter = null;
        if (info.Parameter.Count != 0)
        {
            try
            {
                parameter = ValueCodec.VarValue.Read(Elements.Reader(info.Parameter, types.Registry).Read());
            }
            catch (RobdefException)
            {
                // The error matters more than its parameter, whose type the program may not know.
            }
        }
        return types.MakeException((ErrorCode)info.Code, Text(info.Name), Text(info.Message), Text(info.Subname), parameter);
    }

    public static string Text(RrStr text) => Encoding.UTF8.GetString(text.Data, (int)text.Size);

    /// <summary>Fails a request.</summary>
    public static void Send(nint request, RobdefException error)
    {
        using var name = new NativeText(error.Name);
        using var message = new NativeText(error.Message);
        using var subName = new NativeText(error.SubName);
        using var writer = new ElementWriter(MessageVersion.V4);
        if (error.Parameter is not null)
        {
            error.Parameter.Write(writer, "errorparam"u8);
        }
        fixed (byte* parameter = writer.Written)
        {
            var info = new RrErrorInfo
            {
                Size = (nuint)sizeof(RrErrorInfo),
                Code = (int)error.Code,
                Name = name.Value,
                Message = message.Value,
                Subname = subName.Value,
                Parameter = Elements.Of(parameter, writer),
            };
            // Nobody waits any more when that fails.
            _ = Functions.rr_request_fail(request, &info, null);
        }
    }
}

/// <summary>Views of elements.</summary>
internal static unsafe class Elements
{
    private const uint WithReferences = 0x100;

    public static ElementReader Reader(RrElements elements, TypeRegistry registry) =>
        new(Bytes(elements), (MessageVersion)elements.Version, registry);

    public static FieldReader Fields(RrElements elements, TypeRegistry registry) =>
        new(Bytes(elements), (MessageVersion)elements.Version, registry);

    /// <summary>What is written, whose bytes are pinned at `first`; the arrays that it refers to are pinned here.</summary>
    public static RrElements Of(byte* first, ElementWriter writer)
    {
        writer.PinReferences();
        return new()
        {
            Data = first,
            Size = (nuint)writer.Length,
            Count = (uint)writer.Count,
            Version = (uint)writer.Version | (writer.HasReferences ? WithReferences : 0),
        };
    }

    /// <summary>The first element of an answer, which is released.</summary>
    public static T Take<T>(nint data, ValueCodec<T> codec, TypeRegistry registry)
    {
        try
        {
            return codec.Read(Reader(Functions.rr_data_elements(data), registry).Read());
        }
        finally
        {
            Functions.rr_data_release(data);
        }
    }

    /// <summary>What is text, and is released.</summary>
    public static string TakeText(nint data)
    {
        try
        {
            return Encoding.UTF8.GetString(Bytes(Functions.rr_data_elements(data)));
        }
        finally
        {
            Functions.rr_data_release(data);
        }
    }

    private static ReadOnlySpan<byte> Bytes(RrElements elements) => elements.Size <= int.MaxValue
        ? new ReadOnlySpan<byte>(elements.Data, (int)elements.Size)
        : throw new BufferLimitViolationException("received elements are larger than 2 GiB");
}

/// <summary>Text in UTF-8 that does not move.</summary>
internal readonly unsafe ref struct NativeText
{
    private readonly byte* _data;
    private readonly int _size;

    public NativeText(string text)
    {
        _size = Encoding.UTF8.GetByteCount(text);
        _data = (byte*)System.Runtime.InteropServices.NativeMemory.Alloc((nuint)_size + 1);
        Encoding.UTF8.GetBytes(text, new Span<byte>(_data, _size));
    }

    public RrStr Value => new() { Data = _data, Size = (nuint)_size };

    public void Dispose() => System.Runtime.InteropServices.NativeMemory.Free(_data);
}

/// <summary>One writer for each thread, for the requests that it makes.</summary>
internal static class Writers
{
    // What a large value has left behind is not kept.
    private const int MostKept = 1 << 20;

    [ThreadStatic]
    private static ElementWriter? t_free;

    public static ElementWriter Rent(MessageVersion version)
    {
        ElementWriter? writer = t_free;
        t_free = null;
        if (writer is null)
        {
            return new ElementWriter(version) { MayRefer = true };
        }
        writer.Reset(version);
        return writer;
    }

    public static void Return(ElementWriter writer)
    {
        if (t_free is null && writer.Length <= MostKept)
        {
            writer.Reset(writer.Version);
            t_free = writer;
        }
        else
        {
            writer.Dispose();
        }
    }
}
