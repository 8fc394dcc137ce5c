// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Diagnostics.CodeAnalysis;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>How a subscription keeps its connections.</summary>
public sealed record SubscribeOptions
{
    /// <summary>User, credentials, type and time-out of each connection. Its functions are not called.</summary>
    public ConnectOptions Connect { get; init; } = new();

    /// <summary>From a failure to the next attempt; 2.5 s when not set.</summary>
    public TimeSpan? RetryDelay { get; init; }

    /// <summary>What the delay doubles up to while attempts fail; when not set it does not.</summary>
    public TimeSpan? MaxRetryDelay { get; init; }

    /// <summary>What an attempt may take, all URLs of a service together; 10 s when not set.</summary>
    public TimeSpan? ConnectTimeout { get; init; }

    /// <summary>Which services are wanted; all when not set.</summary>
    public ServiceFilter? Filter { get; init; }

    /// <summary>
    /// Logs in without TLS also at URLs that discovery has found, which anybody on the network can announce. URLs from
    /// elsewhere are not asked about.
    /// </summary>
    public bool AllowClearCredentials { get; init; }

    /// <summary>Told of each connection, and when one is lost. One at a time, in order, on threads of the node. Events of the subscription also tell of which client.</summary>
    public Action? Connected { get; init; }

    /// <summary>Told why a connection has ended.</summary>
    public Action<RobdefException>? Disconnected { get; init; }

    /// <summary>Told why an attempt has failed.</summary>
    public Action<RobdefException>? Failed { get; init; }
}

/// <summary>Which client of a subscription: the node and the name of the service that it is connected to.</summary>
/// <param name="Node">The id of the node.</param>
/// <param name="Service">The service's name.</param>
public readonly record struct SubscribedClientId(Guid Node, string Service)
{
    internal static unsafe SubscribedClientId Of(RrSubscribedClient* client) => new(Copies.Id(client->Node), Failure.Text(client->Service));
}

/// <summary>A client of a subscription.</summary>
/// <param name="Id">Which.</param>
/// <param name="Root">The root object. It belongs to one connection: when that is lost its calls fail.</param>
public sealed record SubscribedClient<TStub>(SubscribedClientId Id, TStub Root)
    where TStub : Stub
{
    /// <summary>The id of the service's node.</summary>
    public Guid Node => Id.Node;

    /// <summary>The service's name.</summary>
    public string Service => Id.Service;
}

/// <summary>The state of one service of a subscription.</summary>
/// <param name="Urls">By which it is reached.</param>
/// <param name="Client">Its client; null unless it is connected.</param>
/// <param name="LastError">Why it is not connected, once an attempt has ended; otherwise null.</param>
/// <param name="Failures">Attempts that have failed since it was last connected.</param>
public sealed record SubscribedService(IReadOnlyList<string> Urls, SubscribedClientId? Client, RobdefException? LastError, long Failures);

/// <summary>The native call that makes a subscription.</summary>
internal unsafe delegate int Subscriber(NativeScope scope, RrSubscribeOptions* options, out nint subscription, nint* error);

/// <summary>
/// Keeps a connection to each of some services, and connects again when one is lost; until it is disposed of or its node
/// ends.
/// </summary>
/// <typeparam name="TStub">The stub of the root objects.</typeparam>
public sealed unsafe class ServiceSubscription<TStub> : IDisposable
    where TStub : Stub, IStub<TStub>
{
    private readonly ServiceSubscriptionHandle _handle;
    private readonly Node _node;
    private readonly Watches _watches = new();
    private readonly CancellationTokenSource _closed = new();

    internal ServiceSubscription(Node node, SubscribeOptions? options, Subscriber subscribe)
    {
        ObjectDisposedException.ThrowIf(node.Handle.IsClosed, node);
        options ??= new SubscribeOptions();
        _node = node;
        using var scope = new NativeScope();
        using var terms = new ConnectTerms(options.Connect with { Closed = null, PathReleased = null }, TStub.RrTypeName);
        RrConnectOptions connect = terms.Native;
        var native = new RrSubscribeOptions
        {
            Size = (nuint)sizeof(RrSubscribeOptions),
            Username = connect.Username,
            Password = connect.Password,
            Credentials = connect.Credentials,
            ObjectType = connect.ObjectType,
            RequestTimeoutMs = connect.RequestTimeoutMs,
            RetryDelayMs = options.RetryDelay is { } delay ? Times.Milliseconds(delay) : 0,
            MaxRetryDelayMs = options.MaxRetryDelay is { } most ? Times.Milliseconds(most) : 0,
            ConnectTimeoutMs = options.ConnectTimeout is { } limit ? Times.Milliseconds(limit) : 0,
            Filter = ServiceFilter.Write(scope, options.Filter),
            AllowClearCredentials = options.AllowClearCredentials ? 1u : 0,
            Context = Context.Of(new SubscriptionSink(options)),
            OnConnected = &SubscriptionSink.OnConnected,
            OnDisconnected = &SubscriptionSink.OnDisconnected,
            OnFailed = &SubscriptionSink.OnFailed,
            Drop = &Context.Drop,
        };
        nint error;
        int status = subscribe(scope, &native, out nint subscription, &error);
        Failure.Check(status, error, KnownTypes.None);
        _handle = new ServiceSubscriptionHandle(subscription);
    }

    /// <summary>A client is connected, or was when the handler was added. The three events come one at a time, in order, on a thread of the node.</summary>
    public event Action<SubscribedClientId> Connected
    {
        add => Watch(nameof(Connected), value, value is null ? null : new SubscribedClientSink { Connected = value });
        remove => _watches.Remove(nameof(Connected), value);
    }

    /// <summary>A client has ended, and why: OperationAborted for this side, ConnectionError for a lost connection, ServiceNotFound for a service that was closed.</summary>
    public event Action<SubscribedClientId, RobdefException> Disconnected
    {
        add => Watch(nameof(Disconnected), value, value is null ? null : new SubscribedClientSink { Disconnected = value });
        remove => _watches.Remove(nameof(Disconnected), value);
    }

    /// <summary>An attempt has failed: the URLs of the service, and the reason of the last of them.</summary>
    public event Action<IReadOnlyList<string>, RobdefException> ConnectFailed
    {
        add => Watch(nameof(ConnectFailed), value, value is null ? null : new SubscribedClientSink { Failed = value });
        remove => _watches.Remove(nameof(ConnectFailed), value);
    }

    /// <summary>Whether it has not been closed.</summary>
    public bool IsOpen => !_handle.IsClosed && Functions.rr_service_subscription_is_open(_handle) != 0;

    /// <summary>The clients that are connected now, those that have been connected longest first.</summary>
    public IReadOnlyList<SubscribedClient<TStub>> Clients
    {
        get
        {
            var clients = new List<SubscribedClient<TStub>>();
            foreach (SubscribedClientId id in Each.Clients(_handle, &Functions.rr_service_subscription_clients))
            {
                if (TryGetRoot(id, out TStub? root))
                {
                    clients.Add(new SubscribedClient<TStub>(id, root));
                }
            }
            return clients;
        }
    }

    /// <summary>The state of each service, connected or not.</summary>
    public IReadOnlyList<SubscribedService> Services => Each.Services(_handle);

    /// <summary>
    /// The root object of the client that has been connected longest. It belongs to one connection: when that is lost its
    /// calls fail, and the next client has another.
    /// </summary>
    /// <param name="limit">How long to wait for a connection; zero does not wait, and ConnectionError says why there is none.</param>
    /// <exception cref="RobdefException">OperationTimeout when none came in time.</exception>
    public TStub GetRoot(TimeSpan limit = default)
    {
        KnownTypes types = TStub.RrServiceDefinition.Known;
        nint error;
        int status = Functions.rr_service_subscription_root(_handle, Times.Milliseconds(limit), out nint root, &error);
        Failure.Check(status, error, types);
        return TStub.RrCreate(new Session(_node, types).Handle(root));
    }

    /// <summary>The same without blocking.</summary>
    /// <param name="limit">How long to wait for a connection; Timeout.InfiniteTimeSpan for as long as it takes.</param>
    /// <param name="cancel">Ends the waiting.</param>
    /// <exception cref="RobdefException">OperationTimeout when none came in time, InvalidOperation when this is closed or the node ends.</exception>
    public Task<TStub> GetRootAsync(TimeSpan limit, CancellationToken cancel = default) =>
        RootWait.For(this, limit, _closed.Token, _node.Ending, cancel);

    /// <summary>The root object of one client; false when it is not connected.</summary>
    public bool TryGetRoot(SubscribedClientId client, [NotNullWhen(true)] out TStub? root)
    {
        KnownTypes types = TStub.RrServiceDefinition.Known;
        using var scope = new NativeScope();
        var native = new RrSubscribedClient
        {
            Size = (nuint)sizeof(RrSubscribedClient),
            Node = Copies.Id(client.Node),
            Service = scope.Text(client.Service),
        };
        nint error;
        int status = Functions.rr_service_subscription_client_root(_handle, &native, out nint found, &error);
        if (status == (int)ErrorCode.ConnectionError)
        {
            Functions.rr_error_release(error);
            root = null;
            return false;
        }
        Failure.Check(status, error, types);
        root = TStub.RrCreate(new Session(_node, types).Handle(found));
        return true;
    }

    /// <summary>From now on these URLs of one service. A connection stays while its URL is among them.</summary>
    public void UpdateUrls(IEnumerable<string> urls) => UpdateServices([urls]);

    /// <summary>From now on these services, each with its URLs. Connections to those that stay among them stay.</summary>
    public void UpdateServices(IEnumerable<IEnumerable<string>> services)
    {
        using var scope = new NativeScope();
        RrServiceUrls* first = scope.Services(services, out nuint count);
        nint error;
        Failure.Check(Functions.rr_service_subscription_update_services(_handle, first, count, &error), error, KnownTypes.None);
    }

    /// <summary>
    /// Of one made by SubscribeTypes: from now on services of these types that pass this filter. Connections to those that
    /// match stay.
    /// </summary>
    /// <exception cref="RobdefException">InvalidOperation when it was made by URLs or is closed, InvalidArgument for a wrong expression.</exception>
    public void UpdateTypes(IEnumerable<string> types, ServiceFilter? filter = null)
    {
        ObjectDisposedException.ThrowIf(_handle.IsClosed, this);
        using var scope = new NativeScope();
        RrStr* first = scope.Texts(types, out nuint count);
        RrServiceFilter* wanted = ServiceFilter.Write(scope, filter);
        nint error;
        Failure.Check(Functions.rr_service_subscription_update_types(_handle, first, count, wanted, &error), error, KnownTypes.None);
    }

    /// <summary>A wire of the object at a path at all clients.</summary>
    /// <param name="member">As the definition calls it.</param>
    /// <param name="codec">Of its values.</param>
    /// <param name="path">Begins with the name of the service or with `*`, which stands for it; empty means the root.</param>
    public WireSubscription<T> SubscribeWire<T>(string member, ValueCodec<T> codec, string path = "") =>
        new(_handle, member, path, codec, TStub.RrServiceDefinition.Known);

    /// <summary>A pipe of the object at a path at all clients.</summary>
    /// <param name="member">As the definition calls it.</param>
    /// <param name="codec">Of its packets.</param>
    /// <param name="path">As of wires.</param>
    /// <param name="maxReceived">When more packets wait the oldest is lost; 0: no limit.</param>
    public PipeSubscription<T> SubscribePipe<T>(string member, ValueCodec<T> codec, string path = "", int maxReceived = 0) =>
        new(_handle, member, path, codec, maxReceived, TStub.RrServiceDefinition.Known);

    /// <summary>The object at a path at the client that has been connected longest. It is looked for when a client comes.</summary>
    /// <param name="path">As of wires: `*.lens`.</param>
    /// <typeparam name="TObject">The stub of the object.</typeparam>
    public ObjectSubscription<TObject> SubscribeObject<TObject>(string path)
        where TObject : Stub, IStub<TObject> => new(_handle, _node, path, TStub.RrServiceDefinition.Known);

    /// <summary>Ends the clients. Handlers of events are told nothing any more.</summary>
    public void Dispose()
    {
        if (!_handle.IsClosed)
        {
            _watches.Clear();
            Functions.rr_service_subscription_close(_handle);
            _handle.Dispose();
            _closed.Cancel();
        }
    }

    /// <summary>Tells of the clients until it is disposed of.</summary>
    internal SubscriptionHandle Watch(SubscribedClientSink sink)
    {
        ObjectDisposedException.ThrowIf(_handle.IsClosed, this);
        var native = new RrServiceSubscriptionHandler
        {
            Size = (nuint)sizeof(RrServiceSubscriptionHandler),
            Context = Context.Of(sink),
            OnConnected = sink.Connected is null ? null : &SubscribedClientSink.OnConnected,
            OnDisconnected = sink.Disconnected is null ? null : &SubscribedClientSink.OnDisconnected,
            OnFailed = sink.Failed is null ? null : &SubscribedClientSink.OnFailed,
            Drop = &Context.Drop,
        };
        nint error;
        Failure.Check(Functions.rr_service_subscription_watch(_handle, &native, out nint watch, &error), error, KnownTypes.None);
        return new SubscriptionHandle(watch);
    }

    private void Watch(string name, Delegate? handler, SubscribedClientSink? sink)
    {
        if (handler is not null && sink is not null)
        {
            _watches.Add(name, handler, Watch(sink));
        }
    }
}

/// <summary>Waits for the first client.</summary>
internal static class RootWait
{
    public static async Task<TStub> For<TStub>(ServiceSubscription<TStub> subscription, TimeSpan limit, CancellationToken closed,
        CancellationToken ending, CancellationToken cancel)
        where TStub : Stub, IStub<TStub>
    {
        cancel.ThrowIfCancellationRequested();
        using var stop = CancellationTokenSource.CreateLinkedTokenSource(cancel, closed, ending);
        if (!subscription.IsOpen)
        {
            throw Closed();
        }
        // Told of those that are there, so that none is missed.
        var came = new SemaphoreSlim(0);
        using SubscriptionHandle watch = subscription.Watch(new SubscribedClientSink { Connected = _ => came.Release() });
        long begin = Stopwatch.GetTimestamp();
        while (true)
        {
            RobdefException why;
            try
            {
                return subscription.GetRoot();
            }
            catch (ConnectionException none)
            {
                why = none;
            }
            catch (ObjectDisposedException)
            {
                throw Closed();
            }
            if (!await Wait(came, Left(limit, begin), stop.Token, cancel).ConfigureAwait(false))
            {
                throw new OperationTimeoutException($"no client in time: {why.Message}");
            }
        }
    }

    /// <summary>In milliseconds; -1 for ever, which is what a semaphore cannot count, too.</summary>
    private static int Left(TimeSpan limit, long begin)
    {
        if (limit == Timeout.InfiniteTimeSpan)
        {
            return Timeout.Infinite;
        }
        double left = Math.Ceiling((limit - Stopwatch.GetElapsedTime(begin)).TotalMilliseconds);
        return left > int.MaxValue ? Timeout.Infinite : (int)Math.Max(left, 0);
    }

    private static async Task<bool> Wait(SemaphoreSlim came, int left, CancellationToken stop, CancellationToken cancel)
    {
        try
        {
            return await came.WaitAsync(left, stop).ConfigureAwait(false);
        }
        catch (OperationCanceledException)
        {
            cancel.ThrowIfCancellationRequested();
            throw Closed();
        }
    }

    private static RobdefInvalidOperationException Closed() => new("the subscription is closed");
}

/// <summary>Where the native runtime tells of a subscription's connections.</summary>
internal sealed unsafe class SubscriptionSink(SubscribeOptions options)
{
    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnConnected(nint context, RrSubscribedClient* client) => Tell(context, static options => options.Connected?.Invoke());

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnDisconnected(nint context, RrSubscribedClient* client, RrErrorInfo* why)
    {
        RobdefException error = Failure.Read(*why, KnownTypes.None);
        Tell(context, options => options.Disconnected?.Invoke(error));
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnFailed(nint context, RrErrorInfo* why)
    {
        RobdefException error = Failure.Read(*why, KnownTypes.None);
        Tell(context, options => options.Failed?.Invoke(error));
    }

    private static void Tell(nint context, Action<SubscribeOptions> tell)
    {
        try
        {
            tell(Context.Get<SubscriptionSink>(context).Options);
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }

    private SubscribeOptions Options => options;
}
