// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Runtime.CompilerServices;
using System.Runtime.ExceptionServices;
using System.Runtime.InteropServices;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>Where the native runtime tells which clients of a subscription come and go.</summary>
internal sealed unsafe class SubscribedClientSink
{
    public Action<SubscribedClientId>? Connected { get; init; }

    public Action<SubscribedClientId, RobdefException>? Disconnected { get; init; }

    public Action<IReadOnlyList<string>, RobdefException>? Failed { get; init; }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnConnected(nint context, RrSubscribedClient* client)
    {
        try
        {
            Context.Get<SubscribedClientSink>(context).Connected?.Invoke(SubscribedClientId.Of(client));
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnDisconnected(nint context, RrSubscribedClient* client, RrErrorInfo* why)
    {
        try
        {
            Context.Get<SubscribedClientSink>(context).Disconnected?.Invoke(SubscribedClientId.Of(client), Failure.Read(*why, KnownTypes.None));
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    public static void OnFailed(nint context, RrStr* urls, nuint count, RrErrorInfo* why)
    {
        try
        {
            Context.Get<SubscribedClientSink>(context).Failed?.Invoke(Copies.Texts(urls, count), Failure.Read(*why, KnownTypes.None));
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }
}

/// <summary>Takes one thing that a native call tells before it returns.</summary>
internal unsafe delegate void TakeClient(RrSubscribedClient* client);

/// <summary>Takes a value or packet that a native call tells before it returns.</summary>
internal unsafe delegate void TakeElements(RrSubscribedClient* client, RrElements elements, DateTimeOffset time);

/// <summary>What native calls tell one by one before they return.</summary>
internal static unsafe class Each
{
    public static IReadOnlyList<SubscribedClientId> Clients(SafeHandle handle,
        delegate*<SafeHandle, nint, delegate* unmanaged[Cdecl]<nint, RrSubscribedClient*, void>, nint*, int> list)
    {
        var clients = new List<SubscribedClientId>();
        var teller = new Teller { Client = client => clients.Add(SubscribedClientId.Of(client)) };
        nint context = Context.Of(teller);
        try
        {
            nint error;
            Failure.Check(list(handle, context, &OnClient, &error), error, KnownTypes.None);
        }
        finally
        {
            Context.Free(context);
        }
        teller.Failure?.Throw();
        return clients;
    }

    public static IReadOnlyList<SubscribedService> Services(SafeHandle handle)
    {
        var services = new List<SubscribedService>();
        nint context = Context.Of(services);
        try
        {
            nint error;
            Failure.Check(Functions.rr_service_subscription_services(handle, context, &OnService, &error), error, KnownTypes.None);
        }
        finally
        {
            Context.Free(context);
        }
        return services;
    }

    /// <summary>The status of a call that tells values of a wire.</summary>
    public static int Values(SafeHandle handle,
        delegate*<SafeHandle, nint, delegate* unmanaged[Cdecl]<nint, RrSubscribedClient*, RrElements*, RrTime*, nint, void>, nint*, int> list,
        TakeElements take, out nint error)
    {
        var teller = new Teller { Elements = take };
        nint context = Context.Of(teller);
        int status;
        try
        {
            nint failure;
            status = list(handle, context, &OnValue, &failure);
            error = failure;
        }
        finally
        {
            Context.Free(context);
        }
        teller.Failure?.Throw();
        return status;
    }

    /// <summary>The packet of a pipe that has waited longest, if there is one.</summary>
    public static void Packet(SafeHandle handle, TakeElements take, KnownTypes types)
    {
        var teller = new Teller { Elements = take };
        nint context = Context.Of(teller);
        try
        {
            nint error;
            Failure.Check(Functions.rr_pipe_subscription_take(handle, context, &OnPacket, &error), error, types);
        }
        finally
        {
            Context.Free(context);
        }
        teller.Failure?.Throw();
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    private static void OnClient(nint context, RrSubscribedClient* client)
    {
        Teller teller = Context.Get<Teller>(context);
        try
        {
            teller.Client!(client);
        }
        catch (Exception exception)
        {
            teller.Failure = ExceptionDispatchInfo.Capture(exception);
        }
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    private static void OnService(nint context, RrSubscribedService* service)
    {
        try
        {
            Context.Get<List<SubscribedService>>(context).Add(new SubscribedService(
                Copies.Texts(service->Urls, service->UrlCount),
                service->Client is null ? null : SubscribedClientId.Of(service->Client),
                service->LastError is null ? null : Failure.Read(*service->LastError, KnownTypes.None),
                (long)Math.Min(service->Failures, long.MaxValue)));
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    private static void OnValue(nint context, RrSubscribedClient* client, RrElements* value, RrTime* time, nint data) =>
        Take(context, client, *value, Times.ToDateTime(*time));

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    private static void OnPacket(nint context, RrSubscribedClient* client, RrElements* packet, nint data) =>
        Take(context, client, *packet, default);

    private static void Take(nint context, RrSubscribedClient* client, RrElements elements, DateTimeOffset time)
    {
        Teller teller = Context.Get<Teller>(context);
        try
        {
            teller.Elements!(client, elements, time);
        }
        catch (Exception exception)
        {
            teller.Failure = ExceptionDispatchInfo.Capture(exception);
        }
    }

    private sealed class Teller
    {
        public TakeClient? Client { get; init; }

        public TakeElements? Elements { get; init; }

        /// <summary>What must not go through native code.</summary>
        public ExceptionDispatchInfo? Failure { get; set; }
    }
}
