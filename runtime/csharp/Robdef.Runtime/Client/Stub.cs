// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Text;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>Calls the handler of an event or the function of a callback with the arguments that came.</summary>
public delegate void EventReader<in THandler>(THandler handler, scoped ref FieldReader arguments);

/// <summary>Calls the function of a callback with the arguments that came.</summary>
public delegate TResult CallbackReader<in TFunction, out TResult>(TFunction function, scoped ref FieldReader arguments);

/// <summary>What generated stubs tell about themselves.</summary>
/// <typeparam name="TSelf">The stub.</typeparam>
public interface IStub<TSelf>
    where TSelf : Stub
{
#pragma warning disable CA1000 // Asked of the type, never of an instance.
    /// <summary>The qualified name of the object in its definition.</summary>
    static abstract string RrTypeName { get; }

    /// <summary>The definition.</summary>
    static abstract ServiceDefinition RrServiceDefinition { get; }

    /// <summary>A stub of an object.</summary>
    static abstract TSelf RrCreate(ObjectHandle rrHandle);
#pragma warning restore CA1000
}

/// <summary>An object on another node. Generated classes derive from it; it may be used by any thread.</summary>
/// <param name="rrHandle">Which object.</param>
public class Stub(ObjectHandle rrHandle)
{
    private const uint PropertyGet = 1111;
    private const uint PropertySet = 1113;
    private const uint FunctionCall = 1121;

    private readonly List<(string Member, Delegate Handler, SubscriptionHandle Subscription)> _subscriptions = [];

    /// <summary>Which object this is.</summary>
    public ObjectHandle RrHandle { get; } = rrHandle;

    /// <summary>Reserves the object for all sessions of this user, or with <paramref name="sessionOnly"/> for this one.</summary>
    public unsafe void RrLock(bool sessionOnly = false)
    {
        using RemoteUse target = RrHandle.Use();
        nint error;
        Failure.Check(Functions.rr_object_lock(target.Native, sessionOnly ? 1 : 0, null, &error), error, RrHandle.Types);
    }

    /// <summary>Ends <see cref="RrLock"/>.</summary>
    public unsafe void RrUnlock()
    {
        using RemoteUse target = RrHandle.Use();
        nint error;
        Failure.Check(Functions.rr_object_unlock(target.Native, null, &error), error, RrHandle.Types);
    }

    /// <summary>Waits until this session alone may use the object; for as long as it takes without a limit.</summary>
    public unsafe void RrEnterMonitor(TimeSpan? limit = null)
    {
        using RemoteUse target = RrHandle.Use();
        nint error;
        int milliseconds = limit is { } time ? Times.Milliseconds(time) : -1;
        Failure.Check(Functions.rr_object_enter_monitor(target.Native, milliseconds, null, &error), error, RrHandle.Types);
    }

    /// <summary>Ends <see cref="RrEnterMonitor"/>.</summary>
    public unsafe void RrExitMonitor()
    {
        using RemoteUse target = RrHandle.Use();
        nint error;
        Failure.Check(Functions.rr_object_exit_monitor(target.Native, null, &error), error, RrHandle.Types);
    }

    /// <summary>The type of what is at an objref now, qualified.</summary>
    /// <param name="member">The objref, as the definition calls it.</param>
    /// <param name="index">Its index, if it has one.</param>
    public unsafe string RrFindType(string member, ObjectIndex index = default)
    {
        using RemoteUse target = RrHandle.Use();
        using var name = new NativeText(member);
        using var text = new NativeText(index.Text ?? "");
        var nativeIndex = new RrIndex { Form = (uint)index.Form, Number = index.Number, Text = text.Value };
        nint error;
        int status = Functions.rr_object_find_type(target.Native, name.Value, &nativeIndex, null, out nint data, &error);
        Failure.Check(status, error, RrHandle.Types);
        return Elements.TakeText(data);
    }

    /// <summary>Asks for a property.</summary>
    protected Call RrGet(ReadOnlySpan<byte> member, MemberAccess access = MemberAccess.None) =>
        new(RrHandle, member, PropertyGet, access);

    /// <summary>Sets a property.</summary>
    protected Call RrSet(ReadOnlySpan<byte> member, MemberAccess access = MemberAccess.None) =>
        new(RrHandle, member, PropertySet, access);

    /// <summary>Calls a function.</summary>
    protected Call RrFunction(ReadOnlySpan<byte> member, MemberAccess access = MemberAccess.None) =>
        new(RrHandle, member, FunctionCall, access);

    /// <summary>Calls a handler with each event until it is taken away, in order, one at a time for each session.</summary>
    protected unsafe void RrSubscribe<THandler>(string member, THandler handler, EventReader<THandler> read)
        where THandler : Delegate
    {
        using RemoteUse target = RrHandle.Use();
        if (handler is null)
        {
            return;
        }
        nint context = Context.Of(new EventSink<THandler>(this, handler, read));
        using var name = new NativeText(member);
        var native = new RrEventHandler
        {
            Size = (nuint)sizeof(RrEventHandler),
            Context = context,
            OnEvent = &EventSink.OnEvent,
            Drop = &Context.Drop,
        };
        nint error;
        int status = Functions.rr_event_subscribe(target.Native, name.Value, &native, out nint subscription, &error);
        Failure.Check(status, error, RrHandle.Types);
        lock (_subscriptions)
        {
            _subscriptions.Add((member, handler, new SubscriptionHandle(subscription)));
        }
    }

    /// <summary>Takes a handler away. When that returns it does not run, unless this is called by it.</summary>
    protected void RrUnsubscribe(string member, Delegate handler)
    {
        SubscriptionHandle? subscription = null;
        lock (_subscriptions)
        {
            int found = _subscriptions.FindLastIndex(one => one.Member == member && one.Handler == handler);
            if (found >= 0)
            {
                subscription = _subscriptions[found].Subscription;
                _subscriptions.RemoveAt(found);
            }
        }
        subscription?.Dispose();
    }

    /// <summary>Gives the service a function to call, or with null none.</summary>
    protected void RrSetCallback<TFunction, TResult>(ReadOnlySpan<byte> member, MemberAccess access, TFunction? function,
        CallbackReader<TFunction, Task<TResult>> read, ValueCodec<TResult> codec)
        where TFunction : Delegate =>
        SetCallback(member, access, returnsValue: true,
            function is null ? null : new CallbackSink<TFunction, TResult>(RrHandle.Session, Encoding.UTF8.GetString(member), function, read, codec));

    /// <summary>Gives the service a function without a result to call, or with null none.</summary>
    protected void RrSetCallback<TFunction>(ReadOnlySpan<byte> member, MemberAccess access, TFunction? function,
        CallbackReader<TFunction, Task> read)
        where TFunction : Delegate =>
        SetCallback(member, access, returnsValue: false,
            function is null ? null : new VoidCallbackSink<TFunction>(RrHandle.Session, Encoding.UTF8.GetString(member), function, read));

    /// <summary>The object at an objref.</summary>
    protected TStub RrFind<TStub>(ReadOnlySpan<byte> member, ObjectIndex index, CancellationToken cancel)
        where TStub : Stub, IStub<TStub> =>
        TStub.RrCreate(RrHandle.Session.Handle(FindNow(member, index, TStub.RrTypeName, cancel)));

    /// <summary>The object at an objref.</summary>
    protected Task<TInterface> RrFindAsync<TStub, TInterface>(ReadOnlySpan<byte> member, ObjectIndex index, CancellationToken cancel)
        where TStub : Stub, IStub<TStub>, TInterface
    {
        Session session = RrHandle.Session;
        return FindLater<TInterface>(member, index, TStub.RrTypeName, found => TStub.RrCreate(session.Handle(found)), cancel);
    }

    /// <summary>The object at an objref of any type: of the class that the program has for its type.</summary>
    protected Stub RrFindAny(ReadOnlySpan<byte> member, ObjectIndex index, CancellationToken cancel) =>
        RrHandle.Types.MakeStub(RrHandle.Session.Handle(FindNow(member, index, "", cancel)));

    /// <summary>The object at an objref of any type: of the class that the program has for its type.</summary>
    protected Task<Stub> RrFindAnyAsync(ReadOnlySpan<byte> member, ObjectIndex index, CancellationToken cancel)
    {
        Session session = RrHandle.Session;
        return FindLater(member, index, "", found => session.Types.MakeStub(session.Handle(found)), cancel);
    }

    private unsafe nint FindNow(ReadOnlySpan<byte> member, ObjectIndex index, string typeName, CancellationToken cancel)
    {
        using RemoteUse target = RrHandle.Use();
        var cancellation = new NativeCancellation(cancel);
        using var type = new NativeText(typeName);
        using var text = new NativeText(index.Text ?? "");
        fixed (byte* name = member)
        {
            cancellation.Begin();
            var nativeIndex = new RrIndex { Form = (uint)index.Form, Number = index.Number, Text = text.Value };
            var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Cancellation = cancellation.Handle };
            nint error;
            int status = Functions.rr_object_find(target.Native, new RrStr { Data = name, Size = (nuint)member.Length },
                &nativeIndex, type.Value, &options, out nint found, &error);
            cancellation.End();
            return status == 0 ? found : throw cancellation.Failed(Failure.Take(status, error, RrHandle.Types));
        }
    }

    private unsafe Task<T> FindLater<T>(ReadOnlySpan<byte> member, ObjectIndex index, string typeName, Func<nint, T> convert,
        CancellationToken cancel)
    {
        if (RrHandle.Refusal<T>(cancel) is { } refused)
        {
            return refused;
        }
        using RemoteUse target = RrHandle.Use();
        var completion = new TaskCompletion<T>(RrHandle.Types, convert, cancel);
        using var type = new NativeText(typeName);
        using var text = new NativeText(index.Text ?? "");
        fixed (byte* name = member)
        {
            var nativeIndex = new RrIndex { Form = (uint)index.Form, Number = index.Number, Text = text.Value };
            var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Cancellation = completion.Cancellation };
            RrCompletion native = completion.Native;
            nint error;
            int status = Functions.rr_object_find_async(target.Native, new RrStr { Data = name, Size = (nuint)member.Length },
                &nativeIndex, type.Value, &options, &native, &error);
            return status == 0 ? completion.Task : Task.FromException<T>(completion.Abandon(native, status, error));
        }
    }

    private unsafe void SetCallback(ReadOnlySpan<byte> member, MemberAccess access, bool returnsValue, CallbackSink? sink)
    {
        if (sink is null && RrHandle.IsGone)
        {
            return;
        }
        using RemoteUse target = RrHandle.Use();
        fixed (byte* name = member)
        {
            var memberName = new RrStr { Data = name, Size = (nuint)member.Length };
            nint error;
            if (sink is null)
            {
                Failure.Check(Functions.rr_callback_clear(target.Native, memberName, &error), error, RrHandle.Types);
                return;
            }
            var native = new RrCallbackHandler
            {
                Size = (nuint)sizeof(RrCallbackHandler),
                Context = Context.Of(sink),
                OnCall = &CallbackSink.OnCall,
                Drop = &Context.Drop,
            };
            int status = Functions.rr_callback_set(target.Native, memberName, (uint)access, returnsValue ? 1 : 0, &native, &error);
            Failure.Check(status, error, RrHandle.Types);
        }
    }
}
