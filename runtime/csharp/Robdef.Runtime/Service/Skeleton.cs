// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>
/// An object that services offer. Generated classes derive from it. Its members are called on
/// threads of the node: for each client one at a time, of different clients at once. A member that is
/// not finished when it returns lets the next request of its client come.
/// </summary>
public abstract unsafe class Skeleton
{
    private readonly Lock _lock = new();
    private readonly Dictionary<uint, Action<ServedHandle>> _streams = [];
    private readonly Dictionary<uint, WirePeeks> _peeks = [];
    private ServedHandle? _handle;
    private int _paths;

    /// <summary>The table of its members.</summary>
    public abstract ServedType RrType { get; }

    /// <summary>The client whose request this thread handles; 0 outside of that.</summary>
    public static uint RrCurrentClient => Functions.rr_current_client();

    /// <summary>Who is logged in there; null for nobody.</summary>
    public static string? RrCurrentUser
    {
        get
        {
            nint error;
            Failure.Check(Functions.rr_current_user(out nint name, &error), error, KnownTypes.None);
            return name == 0 ? null : Elements.TakeText(name);
        }
    }

    /// <summary>
    /// The object is its client's own: each client that follows the objref asks for one, and it is released when
    /// the client goes. To be set before an objref gives it.
    /// </summary>
    public bool RrIsPerClient { get; init; }

    /// <summary>With one, clients may have the object to themselves; null: they may not.</summary>
    protected virtual ObjectMonitor? RrMonitor => null;

    /// <summary>Whether the user of the request that this thread handles has a privilege.</summary>
    public static bool RrCurrentUserHas(string privilege)
    {
        using var text = new NativeText(privilege);
        return Functions.rr_current_user_has(text.Value) != 0;
    }

    internal KnownTypes RrTypes => RrType.Definition.Known;

    /// <summary>The object is reached at a path for the first time, before any request; of the root while it is registered.</summary>
    /// <param name="service">The service, which may be kept.</param>
    /// <param name="path">Of the object.</param>
    protected virtual void RrAttached(Service service, string path)
    {
    }

    /// <summary>The service has forgotten the object at a path.</summary>
    protected virtual void RrReleased(string path)
    {
    }

    /// <summary>Brings a request to its member.</summary>
    protected virtual ValueTask RrRequestAsync(ServedRequest rrRequest) =>
        throw new MemberNotFoundException("the object has no such member");

    /// <summary>The memory at a place of the table.</summary>
    protected virtual ServedMemory? RrMemory(uint rrMember) => null;

    /// <summary>Begins an event, whose arguments follow from the last to the first.</summary>
    protected ServedCall RrEvent(uint member) => new(this, member, MemberAccess.None);

    /// <summary>Begins the call of a callback, whose arguments follow from the last to the first.</summary>
    protected ServedCall RrCallback(uint member, MemberAccess access = MemberAccess.None) => new(this, member, access);

    /// <summary>The native object while a service has it or is about to; null while none does.</summary>
    internal ServedHandle? RrServed
    {
        get
        {
            lock (_lock)
            {
                return _handle;
            }
        }
    }

    /// <summary>The native object, made if there is none.</summary>
    internal ServedHandle RrServe()
    {
        lock (_lock)
        {
            return _handle ??= Make();
        }
    }

    /// <summary>What a pipe or wire does with the native object, now if there is one and whenever one is made.</summary>
    internal void RrWithServed(uint member, Action<ServedHandle> prepare)
    {
        lock (_lock)
        {
            _streams[member] = prepare;
            if (_handle is not null)
            {
                prepare(_handle);
            }
        }
    }

    /// <summary>Who answers when a client asks for the values of a wire.</summary>
    internal void RrSetPeeks(uint member, WirePeeks peeks)
    {
        lock (_lock)
        {
            _peeks[member] = peeks;
        }
    }

    private ServedHandle Make()
    {
        ObjectMonitor? monitor = RrMonitor;
        var native = new RrObjectHandler
        {
            Size = (nuint)sizeof(RrObjectHandler),
            Context = Context.Of(this),
            OnRequest = &OnRequest,
            OnAttached = &OnAttached,
            OnReleased = &OnReleased,
            OnMonitorEnter = monitor is null ? null : &OnMonitorEnter,
            OnMonitorExit = monitor is null ? null : &OnMonitorExit,
            Drop = &Context.Drop,
        };
        nint error;
        Failure.Check(Functions.rr_served_object_new(RrType.Handle, &native, out nint served, &error), error, RrTypes);
        var handle = new ServedHandle(served);
        for (int i = 0; i < RrType.Members.Count; ++i)
        {
            if (RrType.Members[i].Kind == MemberKind.Memory && RrMemory((uint)i) is { } memory)
            {
                memory.Set(handle, (uint)i, RrTypes);
            }
        }
        foreach (Action<ServedHandle> prepare in _streams.Values)
        {
            prepare(handle);
        }
        return handle;
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    private static void OnRequest(nint context, nint request, RrRequestInfo* info)
    {
        Skeleton skeleton = Context.Get<Skeleton>(context);
        string name = skeleton.RrType.Members[(int)info->Member].Name;
        Activity? outer = Activity.Current;
        var measure = Measure.OfRequest(skeleton.RrType, name, info->Kind);
        var served = new ServedRequest(request, *info, skeleton.RrTypes, ServedSession.Find(info->Session), name, measure);
        try
        {
            ValueTask work = served.IsPeek ? skeleton.Peek(served) : skeleton.RrRequestAsync(served);
            if (!work.IsCompletedSuccessfully)
            {
                _ = work.AsTask();
            }
        }
        catch (Exception exception)
        {
            served.Fail(exception);
        }
        if (measure is not null)
        {
            // A handler that goes on later keeps its own.
            Activity.Current = outer;
        }
    }

    private ValueTask Peek(ServedRequest request)
    {
        WirePeeks peeks;
        lock (_lock)
        {
            peeks = _peeks[request.Member];
        }
        return peeks.Answer(request);
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    private static int OnMonitorEnter(nint context, int waitMs)
    {
        try
        {
            ObjectMonitor? monitor = Context.Get<Skeleton>(context).RrMonitor;
            return monitor is not null && monitor.TryEnter(TimeSpan.FromMilliseconds(waitMs)) ? 1 : 0;
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
            return 0;
        }
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    private static void OnMonitorExit(nint context)
    {
        try
        {
            Context.Get<Skeleton>(context).RrMonitor?.Exit();
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    private static void OnAttached(nint context, nint service, RrStr path)
    {
        var handle = new ServiceHandle(service);
        try
        {
            Skeleton skeleton = Context.Get<Skeleton>(context);
            lock (skeleton._lock)
            {
                ++skeleton._paths;
            }
            skeleton.RrAttached(new Service(handle), Failure.Text(path));
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    private static void OnReleased(nint context, RrStr path)
    {
        try
        {
            Skeleton skeleton = Context.Get<Skeleton>(context);
            skeleton.RrReleased(Failure.Text(path));
            ServedHandle? unused = null;
            lock (skeleton._lock)
            {
                if (--skeleton._paths == 0)
                {
                    // Its native half holds this object: it goes when no service has it.
                    unused = skeleton._handle;
                    skeleton._handle = null;
                }
            }
            unused?.Dispose();
        }
        catch (Exception exception)
        {
            Unhandled.Report(exception);
        }
    }
}

/// <summary>What a service's object fails with where nothing is implemented.</summary>
public static class NotServed
{
    /// <summary>A NotImplementedError that names the member.</summary>
    public static RobdefException Member(string name) =>
        new RobdefNotImplementedException($"the member `{name}` is not implemented");
}
