// SPDX-License-Identifier: Apache-2.0
using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>How a subscription keeps its connection.</summary>
public sealed record SubscribeOptions
{
    /// <summary>User, credentials, type and time-out of each connection. Its functions are not called.</summary>
    public ConnectOptions Connect { get; init; } = new();

    /// <summary>From a failure to the next attempt; 2.5 s when not set.</summary>
    public TimeSpan? RetryDelay { get; init; }

    /// <summary>What the delay doubles up to while attempts fail; when not set it does not.</summary>
    public TimeSpan? MaxRetryDelay { get; init; }

    /// <summary>Told of each connection, and when one is lost. One at a time, in order, on threads of the node.</summary>
    public Action? Connected { get; init; }

    /// <summary>Told why a connection has ended.</summary>
    public Action<RobdefException>? Disconnected { get; init; }

    /// <summary>Told why an attempt has failed.</summary>
    public Action<RobdefException>? Failed { get; init; }
}

/// <summary>
/// Keeps a connection to a service, and connects again when it is lost; until it is disposed of or its node ends.
/// </summary>
/// <typeparam name="TStub">The stub of the root object.</typeparam>
public sealed class ServiceSubscription<TStub> : IDisposable
    where TStub : Stub, IStub<TStub>
{
    private readonly ServiceSubscriptionHandle _handle;
    private readonly Node _node;

    internal unsafe ServiceSubscription(Node node, string url, SubscribeOptions options)
    {
        _node = node;
        using var text = new NativeText(url);
        using var terms = new ConnectTerms(options.Connect with { Closed = null, PathReleased = null }, TStub.RrTypeName);
        RrConnectOptions connect = terms.Native;
        RrStr first = text.Value;
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
            Context = Context.Of(new SubscriptionSink(options)),
            OnConnected = &SubscriptionSink.OnConnected,
            OnDisconnected = &SubscriptionSink.OnDisconnected,
            OnFailed = &SubscriptionSink.OnFailed,
            Drop = &Context.Drop,
        };
        nint error;
        int status = Functions.rr_service_subscribe(node.Handle, &first, 1, &native, out nint subscription, &error);
        Failure.Check(status, error, KnownTypes.None);
        _handle = new ServiceSubscriptionHandle(subscription);
    }

    /// <summary>Whether it has not been closed.</summary>
    public bool IsOpen => Functions.rr_service_subscription_is_open(_handle) != 0;

    /// <summary>
    /// The root object of the client that is connected. It belongs to one connection: when that is lost its calls fail,
    /// and the next client has another.
    /// </summary>
    /// <param name="limit">How long to wait for a connection; zero does not wait, and ConnectionError says why there is none.</param>
    /// <exception cref="RobdefException">OperationTimeout when none came in time.</exception>
    public unsafe TStub GetRoot(TimeSpan limit = default)
    {
        KnownTypes types = TStub.RrServiceDefinition.Known;
        nint error;
        int status = Functions.rr_service_subscription_root(_handle, Times.Milliseconds(limit), out nint root, &error);
        Failure.Check(status, error, types);
        return TStub.RrCreate(new Session(_node, types).Handle(root));
    }

    /// <summary>A wire of the object at a path at whichever client is connected.</summary>
    /// <param name="member">As the definition calls it.</param>
    /// <param name="codec">Of its values.</param>
    /// <param name="path">Begins with the name of the service or with `*`, which stands for it; empty means the root.</param>
    public WireSubscription<T> SubscribeWire<T>(string member, ValueCodec<T> codec, string path = "") =>
        new(_handle, member, path, codec, TStub.RrServiceDefinition.Known);

    /// <summary>A pipe of the object at a path at whichever client is connected.</summary>
    /// <param name="member">As the definition calls it.</param>
    /// <param name="codec">Of its packets.</param>
    /// <param name="path">As of wires.</param>
    /// <param name="maxReceived">When more packets wait the oldest is lost; 0: no limit.</param>
    public PipeSubscription<T> SubscribePipe<T>(string member, ValueCodec<T> codec, string path = "", int maxReceived = 0) =>
        new(_handle, member, path, codec, maxReceived, TStub.RrServiceDefinition.Known);

    /// <summary>The object at a path at whichever client is connected, which is looked for when a client comes.</summary>
    /// <param name="path">As of wires: `*.lens`.</param>
    /// <typeparam name="TObject">The stub of the object.</typeparam>
    public ObjectSubscription<TObject> SubscribeObject<TObject>(string path)
        where TObject : Stub, IStub<TObject> => new(_handle, _node, path, TStub.RrServiceDefinition.Known);

    /// <summary>Ends the client.</summary>
    public void Dispose()
    {
        if (!_handle.IsClosed)
        {
            Functions.rr_service_subscription_close(_handle);
            _handle.Dispose();
        }
    }
}

/// <summary>Where the native runtime tells of a subscription's connections.</summary>
internal sealed unsafe class SubscriptionSink(SubscribeOptions options)
{
    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnConnected(nint context, void* client) => Tell(context, static options => options.Connected?.Invoke());

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnDisconnected(nint context, void* client, RrErrorInfo* why)
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
