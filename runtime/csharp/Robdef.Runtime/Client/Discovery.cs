// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>
/// What a node knows of others, and what it tells them: <see cref="Node.Discovery"/>. Nothing happens until something is
/// asked for. May be used by any thread; only the Find and Update forms block, which have asynchronous twins.
/// </summary>
public sealed unsafe class Discovery
{
    private readonly Node _node;
    private readonly Watches _watches = new();

    internal Discovery(Node node) => _node = node;

    /// <summary>
    /// A node that is known, or is found later. Handlers are told one at a time, in order, on a thread of the node.
    /// </summary>
    public event Action<DetectedNode> Detected
    {
        add => Watch(nameof(Detected), value, &NodeSink.OnNode, null);
        remove => _watches.Remove(nameof(Detected), value);
    }

    /// <summary>All ways to reach a node are forgotten.</summary>
    public event Action<DetectedNode> Lost
    {
        add => Watch(nameof(Lost), value, null, &NodeSink.OnNode);
        remove => _watches.Remove(nameof(Lost), value);
    }

    /// <summary>Whether the node listens to others.</summary>
    public bool IsListening => Functions.rr_discovery_is_listening(_node.Handle) != 0;

    /// <summary>The nodes that are known now.</summary>
    public IReadOnlyList<DetectedNode> DetectedNodes
    {
        get
        {
            nint error;
            Failure.Check(Functions.rr_discovery_nodes(_node.Handle, out nint nodes, &error), error, KnownTypes.None);
            return Results.TakeNodes(nodes);
        }
    }

    /// <summary>
    /// Announces this node from now on, at all TCP addresses where it listens, now and later: each period, and when its
    /// services change. While it listens to others as well it answers requests. Replaces earlier options.
    /// </summary>
    /// <exception cref="RobdefException">InvalidOperation after the node's shutdown.</exception>
    public void Announce(AnnounceOptions? options = null)
    {
        options ??= new AnnounceOptions();
        using var scope = new NativeScope();
        var native = new RrAnnounceOptions
        {
            Size = (nuint)sizeof(RrAnnounceOptions),
            Networks = (uint)options.Networks,
            Port = Port(options.Port),
            PeriodMs = options.Period is { } period ? Times.Milliseconds(period) : 0,
        };
        native.Interfaces = scope.Texts(options.Interfaces, out native.InterfaceCount);
        nint error;
        Failure.Check(Functions.rr_discovery_announce(_node.Handle, &native, &error), error, KnownTypes.None);
    }

    /// <summary>Announces this node no more.</summary>
    public void StopAnnouncing() => Functions.rr_discovery_stop_announcing(_node.Handle);

    /// <summary>
    /// Listens to announcements and requests from now on, and asks all nodes for theirs. Replaces earlier options, and then
    /// forgets all nodes.
    /// </summary>
    /// <exception cref="RobdefException">ConnectionError when the port cannot be used, InvalidOperation after the node's shutdown.</exception>
    public void Listen(ListenOptions? options = null)
    {
        options ??= new ListenOptions();
        ArgumentOutOfRangeException.ThrowIfNegative(options.MaxNodes);
        ArgumentOutOfRangeException.ThrowIfNegative(options.MaxNodesOfSender);
        using var scope = new NativeScope();
        var native = new RrListenOptions
        {
            Size = (nuint)sizeof(RrListenOptions),
            Networks = (uint)options.Networks,
            Port = Port(options.Port),
            LifetimeMs = options.Lifetime is { } lifetime ? Times.Milliseconds(lifetime) : 0,
            WithoutLocalNodes = options.FindsLocalNodes ? 0u : 1,
            MaxNodes = (nuint)options.MaxNodes,
            MaxNodesOfSender = (nuint)options.MaxNodesOfSender,
        };
        native.Interfaces = scope.Texts(options.Interfaces, out native.InterfaceCount);
        nint error;
        Failure.Check(Functions.rr_discovery_listen(_node.Handle, &native, &error), error, KnownTypes.None);
    }

    /// <summary>Listens to others no more, and forgets all nodes.</summary>
    public void StopListening() => Functions.rr_discovery_stop_listening(_node.Handle);

    /// <summary>Asks all nodes to announce themselves.</summary>
    /// <exception cref="RobdefException">InvalidOperation unless the node listens.</exception>
    public void Request()
    {
        nint error;
        Failure.Check(Functions.rr_discovery_request(_node.Handle, &error), error, KnownTypes.None);
    }

    /// <summary>
    /// Services whose root object is a <typeparamref name="TStub"/>, or implements it. All Find forms listen with default
    /// options unless the node listens.
    /// </summary>
    /// <exception cref="RobdefException">OperationCancelled when the node is shut down meanwhile.</exception>
    public IReadOnlyList<FoundService> FindServices<TStub>(FindOptions? options = null)
        where TStub : Stub, IStub<TStub> => FindServices([TStub.RrTypeName], options);

    /// <summary>Services whose root object has one of these qualified types, or implements it. No types: all services, the service indexes included.</summary>
    public IReadOnlyList<FoundService> FindServices(IEnumerable<string> types, FindOptions? options = null)
    {
        using var scope = new NativeScope();
        RrFindOptions native = Write(scope, options);
        RrStr* first = scope.Texts(types, out nuint count);
        nint error;
        int status = Functions.rr_discovery_find_services(_node.Handle, first, count, &native, out nint services, &error);
        Failure.Check(status, error, KnownTypes.None);
        return Results.TakeServices(services);
    }

    /// <summary>The same without blocking.</summary>
    public Task<IReadOnlyList<FoundService>> FindServicesAsync<TStub>(FindOptions? options = null, CancellationToken cancel = default)
        where TStub : Stub, IStub<TStub> => FindServicesAsync([TStub.RrTypeName], options, cancel);

    /// <summary>The same without blocking.</summary>
    public Task<IReadOnlyList<FoundService>> FindServicesAsync(IEnumerable<string> types, FindOptions? options = null,
        CancellationToken cancel = default)
    {
        if (cancel.IsCancellationRequested)
        {
            return Task.FromCanceled<IReadOnlyList<FoundService>>(cancel);
        }
        using var scope = new NativeScope();
        RrStr* first = scope.Texts(types, out nuint count);
        RrFindOptions native = Write(scope, options);
        var completion = new TaskCompletion<IReadOnlyList<FoundService>>(KnownTypes.None, Results.TakeServices, cancel);
        native.Cancellation = completion.Cancellation;
        RrCompletion done = completion.Native;
        nint error;
        int status = Functions.rr_discovery_find_services_async(_node.Handle, first, count, &native, &done, &error);
        return Begun(completion, done, status, error);
    }

    /// <summary>The node of this id; null when it is not found.</summary>
    public DetectedNode? FindNode(Guid id, FindOptions? options = null)
    {
        using var scope = new NativeScope();
        RrFindOptions native = Write(scope, options);
        nint error;
        int status = Functions.rr_discovery_find_node(_node.Handle, Copies.Id(id), &native, out nint nodes, &error);
        Failure.Check(status, error, KnownTypes.None);
        return Results.TakeNode(nodes);
    }

    /// <summary>The same without blocking.</summary>
    public Task<DetectedNode?> FindNodeAsync(Guid id, FindOptions? options = null, CancellationToken cancel = default)
    {
        if (cancel.IsCancellationRequested)
        {
            return Task.FromCanceled<DetectedNode?>(cancel);
        }
        using var scope = new NativeScope();
        RrFindOptions native = Write(scope, options);
        var completion = new TaskCompletion<DetectedNode?>(KnownTypes.None, Results.TakeNode, cancel);
        native.Cancellation = completion.Cancellation;
        RrCompletion done = completion.Native;
        nint error;
        int status = Functions.rr_discovery_find_node_async(_node.Handle, Copies.Id(id), &native, &done, &error);
        return Begun(completion, done, status, error);
    }

    /// <summary>All nodes of this name.</summary>
    public IReadOnlyList<DetectedNode> FindNodes(string name, FindOptions? options = null)
    {
        using var scope = new NativeScope();
        RrFindOptions native = Write(scope, options);
        nint error;
        int status = Functions.rr_discovery_find_nodes(_node.Handle, scope.Text(name), &native, out nint nodes, &error);
        Failure.Check(status, error, KnownTypes.None);
        return Results.TakeNodes(nodes);
    }

    /// <summary>The same without blocking.</summary>
    public Task<IReadOnlyList<DetectedNode>> FindNodesAsync(string name, FindOptions? options = null, CancellationToken cancel = default)
    {
        if (cancel.IsCancellationRequested)
        {
            return Task.FromCanceled<IReadOnlyList<DetectedNode>>(cancel);
        }
        using var scope = new NativeScope();
        RrStr text = scope.Text(name);
        RrFindOptions native = Write(scope, options);
        var completion = new TaskCompletion<IReadOnlyList<DetectedNode>>(KnownTypes.None, Results.TakeNodes, cancel);
        native.Cancellation = completion.Cancellation;
        RrCompletion done = completion.Native;
        nint error;
        int status = Functions.rr_discovery_find_nodes_async(_node.Handle, text, &native, &done, &error);
        return Begun(completion, done, status, error);
    }

    /// <summary>As <see cref="DetectedNodes"/>, after asking all nodes and waiting so long.</summary>
    public IReadOnlyList<DetectedNode> UpdateDetectedNodes(TimeSpan wait)
    {
        using var scope = new NativeScope();
        RrFindOptions native = Write(scope, new FindOptions { Wait = wait });
        nint error;
        int status = Functions.rr_discovery_update_nodes(_node.Handle, &native, out nint nodes, &error);
        Failure.Check(status, error, KnownTypes.None);
        return Results.TakeNodes(nodes);
    }

    /// <summary>The same without blocking.</summary>
    public Task<IReadOnlyList<DetectedNode>> UpdateDetectedNodesAsync(TimeSpan wait, CancellationToken cancel = default)
    {
        if (cancel.IsCancellationRequested)
        {
            return Task.FromCanceled<IReadOnlyList<DetectedNode>>(cancel);
        }
        using var scope = new NativeScope();
        RrFindOptions native = Write(scope, new FindOptions { Wait = wait });
        var completion = new TaskCompletion<IReadOnlyList<DetectedNode>>(KnownTypes.None, Results.TakeNodes, cancel);
        native.Cancellation = completion.Cancellation;
        RrCompletion done = completion.Native;
        nint error;
        int status = Functions.rr_discovery_update_nodes_async(_node.Handle, &native, &done, &error);
        return Begun(completion, done, status, error);
    }

    private static uint Port(int port)
    {
        ArgumentOutOfRangeException.ThrowIfLessThan(port, 1);
        ArgumentOutOfRangeException.ThrowIfGreaterThan(port, ushort.MaxValue);
        return (uint)port;
    }

    private static RrFindOptions Write(NativeScope scope, FindOptions? options)
    {
        options ??= new FindOptions();
        var native = new RrFindOptions
        {
            Size = (nuint)sizeof(RrFindOptions),
            WaitMs = Times.Milliseconds(options.Wait),
            TimeoutMs = options.Timeout is { } timeout ? Times.Milliseconds(timeout) : 0,
        };
        native.Schemes = scope.Texts(options.TransportSchemes, out native.SchemeCount);
        return native;
    }

    private static Task<T> Begun<T>(TaskCompletion<T> completion, in RrCompletion done, int status, nint error) =>
        status == 0 ? completion.Task : Task.FromException<T>(completion.Abandon(done, status, error));

    private void Watch(string name, Action<DetectedNode>? handler, delegate* unmanaged[Cdecl]<nint, RrDetectedNode*, void> onDetected,
        delegate* unmanaged[Cdecl]<nint, RrDetectedNode*, void> onLost)
    {
        if (handler is null)
        {
            return;
        }
        ObjectDisposedException.ThrowIf(_node.Handle.IsClosed, _node);
        var native = new RrDiscoveryHandler
        {
            Size = (nuint)sizeof(RrDiscoveryHandler),
            Context = Context.Of(new NodeSink(handler)),
            OnDetected = onDetected,
            OnLost = onLost,
            Drop = &Context.Drop,
        };
        nint error;
        Failure.Check(Functions.rr_discovery_watch(_node.Handle, &native, out nint watch, &error), error, KnownTypes.None);
        _watches.Add(name, handler, new SubscriptionHandle(watch));
    }
}

/// <summary>Where the native runtime tells of a node.</summary>
internal sealed unsafe class NodeSink(Action<DetectedNode> tell)
{
    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnNode(nint context, RrDetectedNode* node)
    {
        try
        {
            Context.Get<NodeSink>(context).Tell(DetectedNode.Of(*node));
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }

    private void Tell(DetectedNode node) => tell(node);
}
