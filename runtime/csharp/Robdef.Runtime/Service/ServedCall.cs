// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

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
        if (_skeleton.RrServed is not { IsClosed: false } served)
        {
            GiveBack();
            return;
        }
        fixed (byte* first = writer is null ? default : writer.Written)
        {
            RrElements elements = writer is null ? default : Elements.Of(first, writer);
            nint error;
            int status = Functions.rr_served_event_fire(served, _member, &elements, &error);
            GiveBack();
            Failure.Check(status, error, _skeleton.RrTypes);
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
        ?? throw new RobdefInvalidOperationException("no service offers the object");

    private nint Send(uint client, CancellationToken cancel)
    {
        ServedHandle served = Served;
        var cancellation = new NativeCancellation(cancel);
        ElementWriter? writer = _writer;
        fixed (byte* first = writer is null ? default : writer.Written)
        {
            cancellation.Begin();
            RrElements elements = writer is null ? default : Elements.Of(first, writer);
            var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Access = (uint)_access, Cancellation = cancellation.Handle };
            nint error;
            int status = Functions.rr_served_callback_call(served, _member, client, &elements, &options, out nint answer, &error);
            cancellation.End();
            GiveBack();
            return status == 0 ? answer : throw cancellation.Failed(Failure.Take(status, error, _skeleton.RrTypes));
        }
    }

    private Task<T> Begin<T>(uint client, ValueCodec<T>? codec, CancellationToken cancel)
    {
        if (cancel.IsCancellationRequested)
        {
            GiveBack();
            return Task.FromCanceled<T>(cancel);
        }
        ServedHandle served = Served;
        var completion = new AnswerCompletion<T>(_skeleton.RrTypes, codec, cancel);
        ElementWriter? writer = _writer;
        fixed (byte* first = writer is null ? default : writer.Written)
        {
            RrElements elements = writer is null ? default : Elements.Of(first, writer);
            var options = new RrCallOptions { Size = (nuint)sizeof(RrCallOptions), Access = (uint)_access, Cancellation = completion.Cancellation };
            RrCompletion native = completion.Native;
            nint error;
            int status = Functions.rr_served_callback_call_async(served, _member, client, &elements, &options, &native, &error);
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
