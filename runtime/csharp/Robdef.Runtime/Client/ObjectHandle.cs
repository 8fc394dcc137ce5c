// SPDX-License-Identifier: Apache-2.0
using System;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>An object on another node, named by its path, with the session through which it is reached.</summary>
public sealed class ObjectHandle
{
    private readonly RemoteHandle _native;
    private string? _path;
    private string? _typeName;

    internal ObjectHandle(RemoteHandle native, Session session)
    {
        _native = native;
        Session = session;
    }

    /// <summary>Its path in the service.</summary>
    public string Path
    {
        get
        {
            if (_path is null)
            {
                using RemoteUse target = Use();
                _path = Failure.Text(Functions.rr_object_path(target.Native));
            }
            return _path;
        }
    }

    /// <summary>Its qualified type, as the service told it.</summary>
    public string TypeName
    {
        get
        {
            if (_typeName is null)
            {
                using RemoteUse target = Use();
                _typeName = Failure.Text(Functions.rr_object_type_name(target.Native));
            }
            return _typeName;
        }
    }

    internal Session Session { get; }

    internal KnownTypes Types => Session.Types;

    internal MessageVersion Version => Session.Version;

    /// <summary>The client was disposed of.</summary>
    internal bool IsGone => _native.IsClosed;

    /// <summary>For one call. ConnectionError when the client was disposed of.</summary>
    internal RemoteUse Use() => new(_native);

    /// <summary>What an asynchronous call is answered with that cannot begin: it is cancelled, or the client was disposed of.</summary>
    internal Task<T>? Refusal<T>(CancellationToken cancel)
    {
        if (cancel.IsCancellationRequested)
        {
            return Task.FromCanceled<T>(cancel);
        }
        return IsGone ? Task.FromException<T>(RemoteUse.Gone()) : null;
    }
}

/// <summary>Keeps the native object for one call, while another thread may dispose of the client.</summary>
internal readonly ref struct RemoteUse
{
    public RemoteUse(RemoteHandle native)
    {
        bool isHeld = false;
        try
        {
            native.DangerousAddRef(ref isHeld);
        }
        catch (ObjectDisposedException)
        {
            throw Gone();
        }
        Native = native;
    }

    public RemoteHandle Native { get; }

    public static RobdefException Gone() => new ConnectionException("the client was disposed of");

    public void Dispose() => Native.DangerousRelease();
}
