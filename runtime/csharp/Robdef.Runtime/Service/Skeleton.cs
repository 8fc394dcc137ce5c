// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>The table of an object's members, made once for its class.</summary>
public sealed unsafe class ServedType
{
    private readonly Lock _lock = new();
    private readonly string _name;
    private ObjectTypeHandle? _handle;

    /// <summary>A table.</summary>
    /// <param name="definition">Where the object is declared.</param>
    /// <param name="name">Its name there.</param>
    /// <param name="members">In the order of their numbers.</param>
    public ServedType(ServiceDefinition definition, string name, IReadOnlyList<ServedMember> members)
    {
        ArgumentNullException.ThrowIfNull(definition);
        Definition = definition;
        _name = name;
        Members = members;
    }

    /// <summary>Where the object is declared.</summary>
    public ServiceDefinition Definition { get; }

    /// <summary>In the order of their numbers.</summary>
    public IReadOnlyList<ServedMember> Members { get; }

    internal ObjectTypeHandle Handle
    {
        get
        {
            lock (_lock)
            {
                return _handle ??= Make();
            }
        }
    }

    private ObjectTypeHandle Make()
    {
        var texts = new List<nint>();
        RrStr Text(string text)
        {
            byte* copy = (byte*)Marshal.StringToCoTaskMemUTF8(text);
            texts.Add((nint)copy);
            return new RrStr { Data = copy, Size = (nuint)System.Text.Encoding.UTF8.GetByteCount(text) };
        }
        var members = new RrMember[Members.Count];
        for (int i = 0; i < members.Length; ++i)
        {
            ServedMember member = Members[i];
            members[i] = new RrMember
            {
                Name = Text(member.Name),
                Kind = (uint)member.Kind,
                Access = (uint)member.Access,
                ReturnsValue = member.ReturnsValue ? 1u : 0,
                Generator = (uint)member.Generator,
                Index = (uint)member.Index,
                ObjectType = Text(member.ObjectType),
                Memory = new RrMemoryType
                {
                    Element = member.Memory.Element,
                    IsMulti = member.Memory.IsMulti ? 1u : 0,
                    Access = member.Kind == MemberKind.Memory ? (uint)member.Access : 0,
                    TransferSize = member.Memory.TransferSize,
                },
            };
        }
        try
        {
            fixed (RrMember* first = members)
            {
                nint error;
                int status = Functions.rr_object_type_new(Definition.Handle, Text(_name), first, (nuint)members.Length,
                    (nuint)sizeof(RrMember), out nint type, &error);
                Failure.Check(status, error, KnownTypes.None);
                return new ObjectTypeHandle(type);
            }
        }
        finally
        {
            texts.ForEach(Marshal.FreeCoTaskMem);
        }
    }
}

/// <summary>
/// An object that services offer. Generated classes derive from it. Its members are called on
/// threads of the node: for each client one at a time, of different clients at once. A member that is
/// not finished when it returns lets the next request of its client come.
/// </summary>
public abstract unsafe class Skeleton
{
    private readonly Lock _lock = new();
    private readonly Dictionary<uint, Action<ServedHandle>> _streams = [];
    private ServedHandle? _handle;
    private int _paths;

    /// <summary>The table of its members.</summary>
    public abstract ServedType RrType { get; }

    /// <summary>The client whose request this thread handles; 0 outside of that.</summary>
    public static uint RrCurrentClient => Functions.rr_current_client();

    internal KnownTypes RrTypes => RrType.Definition.Known;

    /// <summary>The object is reached at a path for the first time.</summary>
    protected virtual void RrAttached(string path)
    {
    }

    /// <summary>The service has forgotten the object at a path.</summary>
    protected virtual void RrReleased(string path)
    {
    }

    /// <summary>Brings a request to its member.</summary>
    protected virtual ValueTask RrRequestAsync(ServedRequest rrRequest) =>
        throw new RobdefException(ErrorCode.MemberNotFound, "the object has no such member");

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

    private ServedHandle Make()
    {
        var native = new RrObjectHandler
        {
            Size = (nuint)sizeof(RrObjectHandler),
            Context = Context.Of(this),
            OnRequest = &OnRequest,
            OnAttached = &OnAttached,
            OnReleased = &OnReleased,
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
        try
        {
            Skeleton skeleton = Context.Get<Skeleton>(context);
            ValueTask work = skeleton.RrRequestAsync(new ServedRequest(request, *info, skeleton.RrTypes));
            if (!work.IsCompletedSuccessfully)
            {
                _ = work.AsTask();
            }
        }
        catch (Exception exception)
        {
            Failure.Send(request, exception);
            Functions.rr_request_release(request);
        }
    }

    [UnmanagedCallersOnly(CallConvs = [typeof(CallConvCdecl)])]
    private static void OnAttached(nint context, nint service, RrStr path)
    {
        Functions.rr_service_release(service);
        try
        {
            Skeleton skeleton = Context.Get<Skeleton>(context);
            lock (skeleton._lock)
            {
                ++skeleton._paths;
            }
            skeleton.RrAttached(Failure.Text(path));
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
        new(ErrorCode.NotImplementedError, $"the member `{name}` is not implemented");
}

/// <summary>An event or the call of a callback, made by generated code. Used once.</summary>
public unsafe ref struct ServedCall
{
    private readonly Skeleton _skeleton;
    private readonly uint _member;
    private readonly MemberAccess _access;
    private ElementWriter? _writer;

    internal ServedCall(Skeleton skeleton, uint member, MemberAccess access)
    {
        _skeleton = skeleton;
        _member = member;
        _access = access;
    }

    /// <summary>Puts an argument in front of those that are there.</summary>
    public ServedCall With<T>(scoped ReadOnlySpan<byte> name, ValueCodec<T> codec, T value)
    {
        ArgumentNullException.ThrowIfNull(codec);
        _writer ??= Writers.Rent(MessageVersion.V4);
        codec.Write(_writer, name, value);
        return this;
    }

    /// <summary>Sends the event to all clients. Never waits; without a service nobody is told.</summary>
    public void Fire()
    {
        ElementWriter? writer = _writer;
        fixed (byte* first = writer is null ? default : writer.Written)
        {
            RrElements elements = writer is null ? default : Elements.Of(first, writer);
            if (_skeleton.RrServed is { IsClosed: false } served)
            {
                nint error;
                int status = Functions.rr_served_event_fire(served, _member, &elements, &error);
                GiveBack();
                Failure.Check(status, error, _skeleton.RrTypes);
            }
        }
    }

    /// <summary>Calls the function of one client, and waits in this thread.</summary>
    public T Call<T>(uint client, ValueCodec<T> codec, CancellationToken cancel) =>
        Elements.Take(Send(client, cancel), codec, _skeleton.RrTypes.Registry);

    /// <summary>The same without a result.</summary>
    public void Call(uint client, CancellationToken cancel) => Functions.rr_data_release(Send(client, cancel));

    /// <summary>Calls the function of one client.</summary>
    public Task<T> CallAsync<T>(uint client, ValueCodec<T> codec, CancellationToken cancel) => Begin(client, codec, cancel);

    /// <summary>The same without a result.</summary>
    public Task CallAsync(uint client, CancellationToken cancel) => Begin<bool>(client, null, cancel);

    private readonly ServedHandle Served => _skeleton.RrServed
        ?? throw new RobdefException(ErrorCode.InvalidOperation, "no service offers the object");

    private nint Send(uint client, CancellationToken cancel)
    {
        var cancellation = new NativeCancellation(cancel);
        ElementWriter? writer = _writer;
        fixed (byte* first = writer is null ? default : writer.Written)
        {
            cancellation.Begin();
            RrElements elements = writer is null ? default : Elements.Of(first, writer);
            var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Access = (uint)_access, Cancellation = cancellation.Handle };
            nint error;
            int status = Functions.rr_served_callback_call(Served, _member, client, &elements, &options, out nint answer, &error);
            cancellation.End();
            GiveBack();
            return status == 0 ? answer : throw cancellation.Failed(Failure.Take(status, error, _skeleton.RrTypes));
        }
    }

    private Task<T> Begin<T>(uint client, ValueCodec<T>? codec, CancellationToken cancel)
    {
        if (cancel.IsCancellationRequested)
        {
            return Task.FromCanceled<T>(cancel);
        }
        var completion = new AnswerCompletion<T>(_skeleton.RrTypes, codec, cancel);
        ElementWriter? writer = _writer;
        fixed (byte* first = writer is null ? default : writer.Written)
        {
            RrElements elements = writer is null ? default : Elements.Of(first, writer);
            var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Access = (uint)_access, Cancellation = completion.Cancellation };
            RrCompletion native = completion.Native;
            nint error;
            int status = Functions.rr_served_callback_call_async(Served, _member, client, &elements, &options, &native, &error);
            GiveBack();
            return status == 0 ? completion.Task : Task.FromException<T>(completion.Abandon(native, status, error));
        }
    }

    private void GiveBack()
    {
        if (_writer is not null)
        {
            Writers.Return(_writer);
            _writer = null;
        }
    }
}
