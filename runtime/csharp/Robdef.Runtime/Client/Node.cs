// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Linq;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>One participant: offers services, and connects to those of others. May be used by any thread.</summary>
public sealed class Node : IDisposable
{
    private readonly NodeHandle _handle;
    private readonly CancellationTokenSource _ending = new();

    /// <summary>A node as the native runtime has it.</summary>
    public Node()
        : this(new NodeOptions())
    {
    }

    /// <summary>A node.</summary>
    public unsafe Node(NodeOptions options)
    {
        ArgumentNullException.ThrowIfNull(options);
        using var scope = new NativeScope();
        var native = new RrNodeOptions
        {
            Size = (nuint)sizeof(RrNodeOptions),
            Name = scope.Text(options.Name),
            ClientWithout = (options.ClientWithoutVersion4 ? 1u : 0) | (options.ClientWithoutStringTable ? 2u : 0)
                | (options.ClientWithoutCombinedConnect ? 4u : 0),
            ServerWithout = (uint)options.ServerWithout,
            ServerStringTable = options.ServerStringTable ? 1u : 0,
            RequestTimeoutMs = options.RequestTimeout is { } request ? Times.Milliseconds(request) : 0,
            ConnectTimeoutMs = options.ConnectTimeout is { } connect ? Times.Milliseconds(connect) : 0,
            HeartbeatPeriodMs = options.HeartbeatPeriod is { } period ? Times.Milliseconds(period) : 0,
            KeepAlivePeriodMs = options.KeepAlivePeriod is { } keep ? Times.Milliseconds(keep) : 0,
            ClientTimeoutMs = options.ClientTimeout is { } silence ? Times.Milliseconds(silence) : 0,
            MessageSize = (uint)options.MessageSize,
            MemoryTransferLimit = (uint)options.MemoryTransferLimit,
            Tls = SecurityTerms.Of(options.Tls, scope),
            Audit = SecurityTerms.Of(options.Audit, scope),
            SharedMemory = options.SharedMemory ? 1u : 0,
            SpinUs = (uint)Math.Clamp(options.Spin.TotalMicroseconds, 0, 1000),
        };
        Faults = new Faults(options.EnableDetailedErrors, options.Log);
        Callbacks = new ServedSession("that a service has called", Faults);
        if (options.Log is { } log)
        {
            native.Context = Context.Of(new LogSink(log));
            native.Log = &LogSink.OnLog;
            native.Drop = &Context.Drop;
        }
        options.Id.TryWriteBytes(new Span<byte>(native.Id.Bytes, 16), bigEndian: true, out _);
        nint error;
        Failure.Check(Functions.rr_node_new(&native, out nint node, &error), error, KnownTypes.None);
        _handle = new NodeHandle(node);
        Discovery = new Discovery(this);
    }

    /// <summary>Its id: that of the options or of its certificate, or a random one.</summary>
    public Guid Id => Copies.Id(Functions.rr_node_get_id(_handle));

    /// <summary>Finding other nodes and their services, and being found.</summary>
    public Discovery Discovery { get; }

    internal NodeHandle Handle => _handle;

    /// <summary>Cancelled when the node is shut down: ends what waits for its subscriptions.</summary>
    internal CancellationToken Ending => _ending.Token;

    /// <summary>What peers are told of exceptions.</summary>
    internal Faults Faults { get; }

    /// <summary>Of callbacks, which services call.</summary>
    internal ServedSession Callbacks { get; }

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
    public Client<TStub> Connect<TStub>(string url, ConnectOptions? options = null)
        where TStub : Stub, IStub<TStub> =>
        ConnectNow(url, TStub.RrServiceDefinition.Known, TStub.RrTypeName, TStub.RrCreate, options);

    /// <summary>
    /// Connects to a service whose root may be of any type: its stub is of the class that one of the definitions
    /// has for it, and else a plain one.
    /// </summary>
    public Client<Stub> Connect(string url, IEnumerable<ServiceDefinition> definitions, ConnectOptions? options = null)
    {
        ArgumentNullException.ThrowIfNull(definitions);
        var types = new KnownTypes(definitions);
        return ConnectNow(url, types, "", types.MakeStub, options);
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
        // Connecting has its own limit and cannot be cancelled: the token ends the waiting.
        var completion = new TaskCompletion<Client<TStub>>(types,
            client => new Client<TStub>(new Session(new ClientHandle(client), this, types), TStub.RrCreate), CancellationToken.None);
        using var text = new NativeText(url);
        using var terms = new ConnectTerms(options, TStub.RrTypeName);
        RrStr first = text.Value;
        RrConnectOptions native = terms.Native;
        RrCompletion done = completion.Native;
        nint error;
        int status = Functions.rr_client_connect_async(_handle, &first, 1, &native, &done, &error);
        if (status != 0)
        {
            return Task.FromException<Client<TStub>>(completion.Abandon(done, status, error));
        }
        return cancel.CanBeCanceled ? UnlessCancelled(completion.Task, cancel) : completion.Task;
    }

    /// <summary>Keeps a connection to the service at a URL, and makes it again when it is lost. Does not wait.</summary>
    public ServiceSubscription<TStub> Subscribe<TStub>(string url, SubscribeOptions? options = null)
        where TStub : Stub, IStub<TStub> => Subscribe<TStub>([url], options);

    /// <summary>The same with several URLs of one service, tried in this order.</summary>
    public unsafe ServiceSubscription<TStub> Subscribe<TStub>(IEnumerable<string> urls, SubscribeOptions? options = null)
        where TStub : Stub, IStub<TStub> =>
        new(this, options, (NativeScope scope, RrSubscribeOptions* native, out nint subscription, nint* error) =>
        {
            RrStr* first = scope.Texts(urls, out nuint count);
            return Functions.rr_service_subscribe(_handle, first, count, native, out subscription, error);
        });

    /// <summary>Keeps a connection to each of several services.</summary>
    /// <param name="services">The URLs of each, tried in their order.</param>
    /// <param name="options">The same for all.</param>
    /// <typeparam name="TStub">The stub of all root objects: of their type, or of one that they implement.</typeparam>
    public unsafe ServiceSubscription<TStub> SubscribeAll<TStub>(IEnumerable<IEnumerable<string>> services, SubscribeOptions? options = null)
        where TStub : Stub, IStub<TStub> =>
        new(this, options, (NativeScope scope, RrSubscribeOptions* native, out nint subscription, nint* error) =>
        {
            RrServiceUrls* first = scope.Services(services, out nuint count);
            return Functions.rr_service_subscribe_all(_handle, first, count, native, out subscription, error);
        });

    /// <summary>The same with one URL for each service.</summary>
    public ServiceSubscription<TStub> SubscribeAll<TStub>(IEnumerable<string> urls, SubscribeOptions? options = null)
        where TStub : Stub, IStub<TStub> => SubscribeAll<TStub>(urls.Select(static url => (IEnumerable<string>)[url]), options);

    /// <summary>
    /// Keeps a connection to each service that discovery finds, whose root object is a <typeparamref name="TStub"/> or
    /// implements it, and that passes the filter of the options. Services come and go with what is announced. Listens with
    /// default options unless <see cref="Discovery.Listen"/> was called.
    /// </summary>
    /// <exception cref="RobdefException">InvalidArgument for a wrong expression in the filter, ConnectionError when discovery cannot be listened to.</exception>
    public ServiceSubscription<TStub> SubscribeTypes<TStub>(SubscribeOptions? options = null)
        where TStub : Stub, IStub<TStub> => SubscribeTypes<TStub>([TStub.RrTypeName], options);

    /// <summary>The same for root objects of some of the types that are, or implement, a <typeparamref name="TStub"/>.</summary>
    /// <param name="types">Qualified names.</param>
    /// <param name="options">With the filter.</param>
    public unsafe ServiceSubscription<TStub> SubscribeTypes<TStub>(IEnumerable<string> types, SubscribeOptions? options = null)
        where TStub : Stub, IStub<TStub> =>
        new(this, options, (NativeScope scope, RrSubscribeOptions* native, out nint subscription, nint* error) =>
        {
            RrStr* first = scope.Texts(types, out nuint count);
            return Functions.rr_service_subscribe_types(_handle, first, count, native, out subscription, error);
        });

    /// <summary>Tells which services discovery finds, without connecting to them. Listens as <see cref="SubscribeTypes{TStub}(SubscribeOptions?)"/>.</summary>
    /// <param name="types">Qualified names of what their root objects are or implement; none: all services.</param>
    /// <param name="filter">What else must hold.</param>
    public ServiceInfoSubscription SubscribeServices(IEnumerable<string> types, ServiceFilter? filter = null) => new(this, types, filter);

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
    public void Shutdown()
    {
        _ending.Cancel();
        Functions.rr_node_shutdown(_handle);
    }

    /// <summary>As <see cref="Shutdown"/>, and lets go of the node.</summary>
    public void Dispose()
    {
        // Not disposed of: subscriptions may still link to it, and it holds nothing but memory.
        _ending.Cancel();
        _handle.Dispose();
    }

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

    private unsafe Client<TStub> ConnectNow<TStub>(string url, KnownTypes types, string typeName, Func<ObjectHandle, TStub> create,
        ConnectOptions? options)
        where TStub : Stub
    {
        using var text = new NativeText(url);
        using var terms = new ConnectTerms(options, typeName);
        RrStr first = text.Value;
        RrConnectOptions native = terms.Native;
        nint error;
        int status = Functions.rr_client_connect(_handle, &first, 1, &native, out nint client, &error);
        Failure.Check(status, error, types);
        return new Client<TStub>(new Session(new ClientHandle(client), this, types), create);
    }
}

/// <summary>Where the native runtime brings what it logs.</summary>
internal sealed unsafe class LogSink(Action<LogSeverity, string> log)
{
    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnLog(nint context, uint level, RrStr text)
    {
        try
        {
            Context.Get<LogSink>(context).Write((LogSeverity)level, Failure.Text(text));
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }

    private void Write(LogSeverity severity, string text) => log(severity, text);
}
