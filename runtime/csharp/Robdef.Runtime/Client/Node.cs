// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>How a node is made. What is not set is as the native runtime has it.</summary>
public sealed record NodeOptions
{
    /// <summary>Its name: letters, digits, `_`, `.` and `-`, a letter first.</summary>
    public string Name { get; init; } = "";

    /// <summary>Its id; a random one when empty.</summary>
    public Guid Id { get; init; }

    /// <summary>How long requests may take.</summary>
    public TimeSpan? RequestTimeout { get; init; }

    /// <summary>How long connecting may take.</summary>
    public TimeSpan? ConnectTimeout { get; init; }

    /// <summary>Clients of this node offer only the older message format.</summary>
    public bool ClientWithoutVersion4 { get; init; }

    /// <summary>Clients of this node do not offer codes for names.</summary>
    public bool ClientWithoutStringTable { get; init; }

    /// <summary>Capabilities that services do not offer: 1 version 4, 2 string table, 4 combined connect.</summary>
    public int ServerWithout { get; init; }

    /// <summary>Services offer codes for names.</summary>
    public bool ServerStringTable { get; init; }

    /// <summary>How often silent connections are tested.</summary>
    public TimeSpan? HeartbeatPeriod { get; init; }

    /// <summary>The largest message, in bytes.</summary>
    public int MessageSize { get; init; }

    /// <summary>The largest part of a memory in one request, in bytes.</summary>
    public int MemoryTransferLimit { get; init; }
}

/// <summary>How a client connects.</summary>
public sealed record ConnectOptions
{
    /// <summary>The user, where the service has users.</summary>
    public string UserName { get; init; } = "";

    /// <summary>The user's password.</summary>
    public string Password { get; init; } = "";

    /// <summary>How long each request may take; the node's limit when not set.</summary>
    public TimeSpan? RequestTimeout { get; init; }
}

/// <summary>One participant: offers services, and connects to those of others. May be used by any thread.</summary>
public sealed class Node : IDisposable
{
    private readonly NodeHandle _handle;

    /// <summary>A node as the native runtime has it.</summary>
    public Node()
        : this(new NodeOptions())
    {
    }

    /// <summary>A node.</summary>
    public unsafe Node(NodeOptions options)
    {
        ArgumentNullException.ThrowIfNull(options);
        using var name = new NativeText(options.Name);
        var native = new RrNodeOptions
        {
            Size = (nuint)sizeof(RrNodeOptions),
            Name = name.Value,
            ClientWithout = (options.ClientWithoutVersion4 ? 1u : 0) | (options.ClientWithoutStringTable ? 2u : 0),
            ServerWithout = (uint)options.ServerWithout,
            ServerStringTable = options.ServerStringTable ? 1u : 0,
            RequestTimeoutMs = options.RequestTimeout is { } request ? Times.Milliseconds(request) : 0,
            ConnectTimeoutMs = options.ConnectTimeout is { } connect ? Times.Milliseconds(connect) : 0,
            HeartbeatPeriodMs = options.HeartbeatPeriod is { } period ? Times.Milliseconds(period) : 0,
            MessageSize = (uint)options.MessageSize,
            MemoryTransferLimit = (uint)options.MemoryTransferLimit,
        };
        options.Id.TryWriteBytes(new Span<byte>(native.Id.Bytes, 16), bigEndian: true, out _);
        nint error;
        Failure.Check(Functions.rr_node_new(&native, out nint node, &error), error, KnownTypes.None);
        _handle = new NodeHandle(node);
    }

    internal NodeHandle Handle => _handle;

    /// <summary>Accepts connections at `rr+tcp://host:port`, port 0 meaning any.</summary>
    /// <returns>The port.</returns>
    public unsafe int Listen(string url)
    {
        using var text = new NativeText(url);
        nint error;
        Failure.Check(Functions.rr_node_listen(_handle, text.Value, out ushort port, &error), error, KnownTypes.None);
        return port;
    }

    /// <summary>Connects to the service at a URL, in the thread of the caller.</summary>
    public unsafe Client<TStub> Connect<TStub>(string url, ConnectOptions? options = null)
        where TStub : Stub, IStub<TStub>
    {
        KnownTypes types = TStub.RrServiceDefinition.Known;
        options ??= new ConnectOptions();
        using var text = new NativeText(url);
        using var user = new NativeText(options.UserName);
        using var password = new NativeText(options.Password);
        using var type = new NativeText(TStub.RrTypeName);
        RrStr first = text.Value;
        RrConnectOptions native = Native(options, user.Value, password.Value, type.Value);
        nint error;
        int status = Functions.rr_client_connect(_handle, &first, 1, &native, out nint client, &error);
        Failure.Check(status, error, types);
        return new Client<TStub>(new Session(new ClientHandle(client), this, types));
    }

    /// <summary>Connects to the service at a URL.</summary>
    public unsafe Task<Client<TStub>> ConnectAsync<TStub>(string url, ConnectOptions? options = null, CancellationToken cancel = default)
        where TStub : Stub, IStub<TStub>
    {
        if (cancel.IsCancellationRequested)
        {
            return Task.FromCanceled<Client<TStub>>(cancel);
        }
        KnownTypes types = TStub.RrServiceDefinition.Known;
        options ??= new ConnectOptions();
        // Connecting has its own limit and cannot be cancelled: the token ends the waiting.
        var completion = new TaskCompletion<Client<TStub>>(types, client => new Client<TStub>(new Session(new ClientHandle(client), this, types)), CancellationToken.None);
        using var text = new NativeText(url);
        using var user = new NativeText(options.UserName);
        using var password = new NativeText(options.Password);
        using var type = new NativeText(TStub.RrTypeName);
        RrStr first = text.Value;
        RrConnectOptions native = Native(options, user.Value, password.Value, type.Value);
        RrCompletion done = completion.Native;
        nint error;
        int status = Functions.rr_client_connect_async(_handle, &first, 1, &native, &done, &error);
        if (status != 0)
        {
            return Task.FromException<Client<TStub>>(completion.Abandon(done, status, error));
        }
        return cancel.CanBeCanceled ? UnlessCancelled(completion.Task, cancel) : completion.Task;
    }

    /// <summary>Offers an object and what it refers to, until the service is closed or the node ends.</summary>
    /// <param name="name">The service's name.</param>
    /// <param name="root">Its root object.</param>
    /// <param name="options">Users and attributes.</param>
    public Service Register(string name, Skeleton root, ServiceOptions? options = null)
    {
        ArgumentNullException.ThrowIfNull(root);
        return Service.Register(this, name, root, options ?? new ServiceOptions());
    }

    /// <summary>Ends all services and connections, and waits for handlers that run.</summary>
    public void Shutdown() => Functions.rr_node_shutdown(_handle);

    /// <summary>As <see cref="Shutdown"/>, and lets go of the node.</summary>
    public void Dispose() => _handle.Dispose();

    private static async Task<Client<TStub>> UnlessCancelled<TStub>(Task<Client<TStub>> connecting, CancellationToken cancel)
        where TStub : Stub, IStub<TStub>
    {
        try
        {
            return await connecting.WaitAsync(cancel).ConfigureAwait(false);
        }
        catch (OperationCanceledException)
        {
            // A connection that comes too late is closed again.
            _ = connecting.ContinueWith(static late => late.Result.Dispose(), CancellationToken.None,
                TaskContinuationOptions.OnlyOnRanToCompletion, TaskScheduler.Default);
            throw;
        }
    }

    private static unsafe RrConnectOptions Native(ConnectOptions options, RrStr user, RrStr password, RrStr type) => new()
    {
        Size = (nuint)sizeof(RrConnectOptions),
        Username = user,
        Password = password,
        ObjectType = type,
        RequestTimeoutMs = options.RequestTimeout is { } timeout ? Times.Milliseconds(timeout) : 0,
    };
}

/// <summary>The connection of a client: what its objects have in common.</summary>
internal sealed class Session
{
    public Session(ClientHandle client, Node node, KnownTypes types)
    {
        Client = client;
        Node = node;
        Types = types;
        Version = (MessageVersion)Functions.rr_client_message_version(client);
    }

    public ClientHandle Client { get; }

    /// <summary>Kept, so that it does not end while a client uses it.</summary>
    public Node Node { get; }

    public KnownTypes Types { get; }

    public MessageVersion Version { get; }

    public ObjectHandle Handle(nint native) => new(new RemoteHandle(native), this);
}

/// <summary>A session with a service. Disposing it ends the session; its stubs then fail.</summary>
/// <typeparam name="TStub">The stub of the root object.</typeparam>
public sealed class Client<TStub> : IDisposable, IAsyncDisposable
    where TStub : Stub, IStub<TStub>
{
    private readonly Session _session;

    internal unsafe Client(Session session)
    {
        _session = session;
        nint error;
        Failure.Check(Functions.rr_client_root(session.Client, out nint root, &error), error, session.Types);
        Root = TStub.RrCreate(session.Handle(root));
    }

    /// <summary>The root object.</summary>
    public TStub Root { get; }

    /// <summary>Whether the session goes on.</summary>
    public bool IsOpen => Functions.rr_client_is_open(_session.Client) != 0;

    /// <summary>The message format in which this connection speaks.</summary>
    public MessageVersion MessageVersion => _session.Version;

    /// <summary>Tells the service, waits for its answer for half a second at most, and ends the connection.</summary>
    public void Close() => Functions.rr_client_close(_session.Client);

    /// <summary>Closes the session and lets go of it.</summary>
    public void Dispose() => _session.Client.Dispose();

    /// <summary>The same, on another thread.</summary>
    public ValueTask DisposeAsync() => new(Task.Run(_session.Client.Dispose));
}
