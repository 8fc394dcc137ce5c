// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;

namespace Robdef.Runtime.Native;

/// <summary>A map of varvalues as elements that do not move; none for null.</summary>
internal readonly unsafe ref struct NativeElements
{
    private readonly byte* _data;
    private readonly int _size;
    private readonly int _count;

    public NativeElements(Dictionary<string, VarValue?>? map)
    {
        if (map is null)
        {
            return;
        }
        using var writer = new ElementWriter(MessageVersion.V4);
        VarValueCodec.StringMap.Write(writer, "value"u8, map);
        _size = writer.Length;
        _count = writer.Count;
        _data = (byte*)NativeMemory.Alloc((nuint)_size + 1);
        writer.Written.CopyTo(new Span<byte>(_data, _size));
    }

    public RrElements Value => new()
    {
        Data = _data,
        Size = (nuint)_size,
        Count = (uint)_count,
        Version = (uint)MessageVersion.V4,
    };

    public void Dispose() => NativeMemory.Free(_data);
}

/// <summary>The native form of what a client connects with. What it is told of is held by the native side from the call on.</summary>
internal readonly unsafe ref struct ConnectTerms
{
    private readonly NativeText _user;
    private readonly NativeText _password;
    private readonly NativeText _type;
    private readonly NativeElements _credentials;
    private readonly RrConnectOptions _native;

    public ConnectTerms(ConnectOptions? options, string typeName)
    {
        options ??= new ConnectOptions();
        _user = new NativeText(options.UserName);
        _password = new NativeText(options.Password);
        _type = new NativeText(options.ObjectType.Length != 0 ? options.ObjectType : typeName);
        _credentials = new NativeElements(options.Credentials);
        _native = new RrConnectOptions
        {
            Size = (nuint)sizeof(RrConnectOptions),
            Username = _user.Value,
            Password = _password.Value,
            Credentials = _credentials.Value,
            ObjectType = _type.Value,
            RequestTimeoutMs = options.RequestTimeout is { } timeout ? Times.Milliseconds(timeout) : 0,
            AllowClearCredentials = options.AllowClearCredentials ? 1u : 0,
        };
        if (options.Closed is not null || options.PathReleased is not null)
        {
            _native.Context = Context.Of(new SessionSink(options));
            _native.OnClosed = &SessionSink.OnClosed;
            _native.OnPathReleased = &SessionSink.OnPathReleased;
            _native.Drop = &Context.Drop;
        }
    }

    public RrConnectOptions Native => _native;

    public void Dispose()
    {
        _user.Dispose();
        _password.Dispose();
        _type.Dispose();
        _credentials.Dispose();
    }
}

/// <summary>Where the native runtime tells what becomes of a session.</summary>
internal sealed unsafe class SessionSink(ConnectOptions options)
{
    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnClosed(nint context, RrErrorInfo* why)
    {
        try
        {
            Context.Get<SessionSink>(context).Close(Failure.Read(*why, KnownTypes.None));
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnPathReleased(nint context, RrStr path)
    {
        try
        {
            Context.Get<SessionSink>(context).Release(Failure.Text(path));
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }

    private void Close(RobdefException why) => options.Closed?.Invoke(why);

    private void Release(string path) => options.PathReleased?.Invoke(path);
}
