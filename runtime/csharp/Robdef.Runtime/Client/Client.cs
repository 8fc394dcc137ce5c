// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>The connection of a client: what its objects have in common.</summary>
internal sealed class Session
{
    private const int FewObjects = 8;

    private readonly Lock _lock = new();
    private readonly List<WeakReference<RemoteHandle>> _objects = [];
    private int _enough = FewObjects;
    private bool _hasEnded;

    public Session(ClientHandle client, Node node, KnownTypes types)
        : this(node, types, (MessageVersion)Functions.rr_client_message_version(client)) => Client = client;

    /// <summary>One that a subscription has made, which does not tell its version: what is sent is written anew where it must be.</summary>
    public Session(Node node, KnownTypes types)
        : this(node, types, MessageVersion.V4)
    {
    }

    private Session(Node node, KnownTypes types, MessageVersion version)
    {
        Node = node;
        Types = types;
        Version = version;
    }

    /// <summary>Null in that of a subscription.</summary>
    public ClientHandle? Client { get; }

    /// <summary>Kept, so that it does not end while a client uses it.</summary>
    public Node Node { get; }

    public KnownTypes Types { get; }

    public MessageVersion Version { get; }

    public ObjectHandle Handle(nint native)
    {
        var handle = new RemoteHandle(native);
        bool hasEnded;
        lock (_lock)
        {
            hasEnded = _hasEnded;
            if (_objects.Count >= _enough)
            {
                _objects.RemoveAll(static one => !one.TryGetTarget(out _));
                _enough = Math.Max(FewObjects, 2 * _objects.Count);
            }
            _objects.Add(new WeakReference<RemoteHandle>(handle));
        }
        if (hasEnded)
        {
            handle.Dispose();
        }
        return new ObjectHandle(handle, this);
    }

    /// <summary>
    /// Ends the session and lets go of its objects. They keep the native session, and with it the socket, which is not to
    /// wait until the garbage collector comes to the stubs.
    /// </summary>
    public void End()
    {
        Client?.Dispose();
        WeakReference<RemoteHandle>[] objects;
        lock (_lock)
        {
            _hasEnded = true;
            objects = [.. _objects];
            _objects.Clear();
        }
        foreach (WeakReference<RemoteHandle> one in objects)
        {
            if (one.TryGetTarget(out RemoteHandle? handle))
            {
                handle.Dispose();
            }
        }
    }
}

/// <summary>A session with a service. Disposing it ends the session; its stubs then fail.</summary>
/// <typeparam name="TStub">The stub of the root object.</typeparam>
public sealed class Client<TStub> : IDisposable, IAsyncDisposable
    where TStub : Stub
{
    private readonly Session _session;
    private readonly ClientHandle _handle;

    internal unsafe Client(Session session, Func<ObjectHandle, TStub> create)
    {
        _session = session;
        _handle = session.Client!;
        nint error;
        Failure.Check(Functions.rr_client_root(_handle, out nint root, &error), error, session.Types);
        Root = create(session.Handle(root));
    }

    /// <summary>The root object.</summary>
    public TStub Root { get; }

    /// <summary>Whether the session goes on.</summary>
    public bool IsOpen => Functions.rr_client_is_open(_handle) != 0;

    /// <summary>The message format in which this connection speaks.</summary>
    public MessageVersion MessageVersion => _session.Version;

    /// <summary>The name of the service's node.</summary>
    public string RemoteName => Failure.Text(Functions.rr_client_remote_name(_handle));

    /// <summary>The id of the service's node.</summary>
    public unsafe Guid RemoteNode
    {
        get
        {
            RrNodeId id = Functions.rr_client_remote_node(_handle);
            return new Guid(new ReadOnlySpan<byte>(id.Bytes, 16), bigEndian: true);
        }
    }

    /// <summary>What the service said about itself in connecting.</summary>
    public unsafe Dictionary<string, VarValue?> GetAttributes()
    {
        nint error;
        Failure.Check(Functions.rr_client_attributes(_handle, out nint data, &error), error, _session.Types);
        return Elements.Take(data, VarValueCodec.StringMap, _session.Types.Registry) ?? [];
    }

    /// <summary>What the service says about itself now; asked in the thread of the caller.</summary>
    public unsafe Dictionary<string, VarValue?> FetchAttributes()
    {
        nint error;
        Failure.Check(Functions.rr_client_fetch_attributes(_handle, out nint data, &error), error, _session.Types);
        return Elements.Take(data, VarValueCodec.StringMap, _session.Types.Registry) ?? [];
    }

    /// <summary>Logs in, perhaps as another user than in connecting.</summary>
    public void Authenticate(string userName, string password) => Authenticate(userName, password, null);

    /// <summary>Logs in with something else than a password.</summary>
    public void Authenticate(string userName, Dictionary<string, VarValue?> credentials) => Authenticate(userName, "", credentials);

    /// <summary>Logs out.</summary>
    public unsafe void Logout()
    {
        nint error;
        Failure.Check(Functions.rr_client_logout(_handle, &error), error, _session.Types);
    }

    /// <summary>Ends all open calls with OperationCancelled.</summary>
    public void CancelCalls() => Functions.rr_client_cancel_calls(_handle);

    /// <summary>Tells the service, waits for its answer for half a second at most, and ends the connection.</summary>
    public void Close() => Functions.rr_client_close(_handle);

    /// <summary>Closes the session and lets go of it.</summary>
    public void Dispose() => _session.End();

    /// <summary>The same, on another thread.</summary>
    public ValueTask DisposeAsync() => new(Task.Run(_session.End));

    private unsafe void Authenticate(string userName, string password, Dictionary<string, VarValue?>? credentials)
    {
        using var user = new NativeText(userName);
        using var secret = new NativeText(password);
        using var values = new NativeElements(credentials);
        RrElements native = values.Value;
        nint error;
        int status = Functions.rr_client_authenticate(_handle, user.Value, secret.Value, &native, &error);
        Failure.Check(status, error, _session.Types);
    }
}
