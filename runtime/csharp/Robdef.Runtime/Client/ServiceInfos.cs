// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>
/// Services that match, without connections to them: <see cref="Node.SubscribeServices"/>. Until it is disposed of or its
/// node ends.
/// </summary>
public sealed unsafe class ServiceInfoSubscription : IDisposable
{
    private readonly ServiceInfoSubscriptionHandle _handle;
    private readonly Watches _watches = new();

    internal ServiceInfoSubscription(Node node, IEnumerable<string> types, ServiceFilter? filter)
    {
        ObjectDisposedException.ThrowIf(node.Handle.IsClosed, node);
        using var scope = new NativeScope();
        RrStr* first = scope.Texts(types, out nuint count);
        RrServiceFilter* wanted = ServiceFilter.Write(scope, filter);
        nint error;
        int status = Functions.rr_service_info_subscribe(node.Handle, first, count, wanted, null, out nint subscription, &error);
        Failure.Check(status, error, KnownTypes.None);
        _handle = new ServiceInfoSubscriptionHandle(subscription);
    }

    /// <summary>A service that is there, or is found later. Handlers are told one at a time, in order, on a thread of the node.</summary>
    public event Action<FoundService> Detected
    {
        add => Watch(nameof(Detected), value, &ServiceSink.OnService, null, null);
        remove => _watches.Remove(nameof(Detected), value);
    }

    /// <summary>The attributes or URLs of a service are others now.</summary>
    public event Action<FoundService> Changed
    {
        add => Watch(nameof(Changed), value, null, &ServiceSink.OnService, null);
        remove => _watches.Remove(nameof(Changed), value);
    }

    /// <summary>A service is there no more.</summary>
    public event Action<FoundService> Lost
    {
        add => Watch(nameof(Lost), value, null, null, &ServiceSink.OnService);
        remove => _watches.Remove(nameof(Lost), value);
    }

    /// <summary>Whether it has not been closed.</summary>
    public bool IsOpen => !_handle.IsClosed && Functions.rr_service_info_subscription_is_open(_handle) != 0;

    /// <summary>Those that are there now.</summary>
    public IReadOnlyList<FoundService> Services
    {
        get
        {
            nint error;
            Failure.Check(Functions.rr_service_info_subscription_services(_handle, out nint services, &error), error, KnownTypes.None);
            return Results.TakeServices(services);
        }
    }

    /// <summary>Handlers are told nothing any more.</summary>
    public void Dispose()
    {
        if (!_handle.IsClosed)
        {
            Functions.rr_service_info_subscription_close(_handle);
            _handle.Dispose();
            _watches.Clear();
        }
    }

    private void Watch(string name, Action<FoundService>? handler, delegate* unmanaged[Cdecl]<nint, RrFoundService*, void> onDetected,
        delegate* unmanaged[Cdecl]<nint, RrFoundService*, void> onChanged, delegate* unmanaged[Cdecl]<nint, RrFoundService*, void> onLost)
    {
        if (handler is null)
        {
            return;
        }
        ObjectDisposedException.ThrowIf(_handle.IsClosed, this);
        var native = new RrServiceInfoHandler
        {
            Size = (nuint)sizeof(RrServiceInfoHandler),
            Context = Context.Of(new ServiceSink(handler)),
            OnDetected = onDetected,
            OnChanged = onChanged,
            OnLost = onLost,
            Drop = &Context.Drop,
        };
        nint error;
        int status = Functions.rr_service_info_subscription_watch(_handle, &native, out nint watch, &error);
        Failure.Check(status, error, KnownTypes.None);
        _watches.Add(name, handler, new SubscriptionHandle(watch));
    }
}

/// <summary>Where the native runtime tells of a service.</summary>
internal sealed unsafe class ServiceSink(Action<FoundService> tell)
{
    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnService(nint context, RrFoundService* service)
    {
        try
        {
            Context.Get<ServiceSink>(context).Tell(FoundService.Of(*service));
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }

    private void Tell(FoundService service) => tell(service);
}
