// SPDX-License-Identifier: Apache-2.0
using System;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>
/// A request to a member of an object on another node, made by generated code: its arguments from
/// the last to the first, and then one of the verbs, which sends it. Used once.
/// </summary>
public ref struct Call
{
    private readonly ObjectHandle _object;
    private readonly ReadOnlySpan<byte> _member;
    private readonly uint _request;
    private readonly MemberAccess _access;
    private ElementWriter? _writer;

    internal Call(ObjectHandle target, ReadOnlySpan<byte> member, uint request, MemberAccess access)
    {
        _object = target;
        _member = member;
        _request = request;
        _access = access;
    }

    /// <summary>Puts an argument in front of those that are there.</summary>
    public Call With<T>(scoped ReadOnlySpan<byte> name, ValueCodec<T> codec, T value)
    {
        ArgumentNullException.ThrowIfNull(codec);
        _writer ??= Writers.Rent(_object.Version);
        codec.Write(_writer, name, value);
        return this;
    }

    /// <summary>Sends the request and waits in this thread, which reads the connection itself.</summary>
    /// <exception cref="RobdefException">What the service has thrown, or what went wrong on the way.</exception>
    /// <exception cref="OperationCanceledException">The token was cancelled; the service goes on.</exception>
    public T Run<T>(ValueCodec<T> codec, CancellationToken cancel) => Elements.Take(Send(cancel), codec, _object.Types.Registry);

    /// <summary>The same without a result.</summary>
    public void Run(CancellationToken cancel) => Functions.rr_data_release(Send(cancel));

    /// <summary>Sends the request and goes on; the task ends on a thread of the pool.</summary>
    public Task<T> RunAsync<T>(ValueCodec<T> codec, CancellationToken cancel) => Begin(codec, cancel);

    /// <summary>The same without a result.</summary>
    public Task RunAsync(CancellationToken cancel) => Begin<bool>(null, cancel);

    /// <summary>Opens a generator that gives values.</summary>
    public Generator<T> Open<T>(ValueCodec<T> codec, CancellationToken cancel) => new(OpenNow(cancel), _object, codec);

    /// <summary>Opens a generator that gives values.</summary>
    public Task<Generator<T>> OpenAsync<T>(ValueCodec<T> codec, CancellationToken cancel)
    {
        ObjectHandle target = _object;
        return OpenLater(handle => new Generator<T>(new GeneratorHandle(handle), target, codec), cancel);
    }

    /// <summary>Opens a generator that takes values.</summary>
    public GeneratorSink<T> OpenSink<T>(ValueCodec<T> codec, CancellationToken cancel) => new(OpenNow(cancel), _object, codec);

    /// <summary>Opens a generator that takes values.</summary>
    public Task<GeneratorSink<T>> OpenSinkAsync<T>(ValueCodec<T> codec, CancellationToken cancel)
    {
        ObjectHandle target = _object;
        return OpenLater(handle => new GeneratorSink<T>(new GeneratorHandle(handle), target, codec), cancel);
    }

    /// <summary>Opens a generator that takes and gives values.</summary>
    public GeneratorFilter<TIn, TOut> OpenFilter<TIn, TOut>(ValueCodec<TIn> taken, ValueCodec<TOut> given, CancellationToken cancel) =>
        new(OpenNow(cancel), _object, taken, given);

    /// <summary>Opens a generator that takes and gives values.</summary>
    public Task<GeneratorFilter<TIn, TOut>> OpenFilterAsync<TIn, TOut>(ValueCodec<TIn> taken, ValueCodec<TOut> given, CancellationToken cancel)
    {
        ObjectHandle target = _object;
        return OpenLater(handle => new GeneratorFilter<TIn, TOut>(new GeneratorHandle(handle), target, taken, given), cancel);
    }

    private nint Send(CancellationToken cancel)
    {
        if (Measure.OfCall(_object, _member, _request) is not { } measure)
        {
            return SendUnmeasured(cancel);
        }
        try
        {
            nint answer = SendUnmeasured(cancel);
            measure.End(null);
            return answer;
        }
        catch (Exception exception)
        {
            measure.End(exception);
            throw;
        }
    }

    private unsafe nint SendUnmeasured(CancellationToken cancel)
    {
        using RemoteUse target = _object.Use();
        var cancellation = new NativeCancellation(cancel);
        ElementWriter? writer = _writer;
        fixed (byte* name = _member, first = writer is null ? default : writer.Written)
        {
            cancellation.Begin();
            RrElements elements = writer is null ? default : Elements.Of(first, writer);
            RrCallOptions options = Options(cancellation.Handle);
            nint error;
            int status = Functions.rr_object_call(target.Native, _request, Name(name), &elements, &options, out nint answer, &error);
            cancellation.End();
            GiveBack();
            return status == 0 ? answer : throw cancellation.Failed(Failure.Take(status, error, _object.Types));
        }
    }

    private unsafe Task<T> Begin<T>(ValueCodec<T>? codec, CancellationToken cancel)
    {
        if (_object.Refusal<T>(cancel) is { } refused)
        {
            GiveBack();
            return refused;
        }
        using RemoteUse target = _object.Use();
        var completion = new AnswerCompletion<T>(_object.Types, codec, cancel) { Measure = Measure.OfCall(_object, _member, _request) };
        ElementWriter? writer = _writer;
        fixed (byte* name = _member, first = writer is null ? default : writer.Written)
        {
            RrElements elements = writer is null ? default : Elements.Of(first, writer);
            RrCallOptions options = Options(completion.Cancellation);
            RrCompletion native = completion.Native;
            nint error;
            int status = Functions.rr_object_call_async(target.Native, _request, Name(name), &elements, &options, &native, &error);
            GiveBack();
            return status == 0 ? completion.Task : Task.FromException<T>(completion.Abandon(native, status, error));
        }
    }

    private GeneratorHandle OpenNow(CancellationToken cancel)
    {
        if (Measure.OfCall(_object, _member, _request) is not { } measure)
        {
            return OpenUnmeasured(cancel);
        }
        try
        {
            GeneratorHandle generator = OpenUnmeasured(cancel);
            measure.End(null);
            return generator;
        }
        catch (Exception exception)
        {
            measure.End(exception);
            throw;
        }
    }

    private unsafe GeneratorHandle OpenUnmeasured(CancellationToken cancel)
    {
        using RemoteUse target = _object.Use();
        var cancellation = new NativeCancellation(cancel);
        ElementWriter? writer = _writer;
        fixed (byte* name = _member, first = writer is null ? default : writer.Written)
        {
            cancellation.Begin();
            RrElements elements = writer is null ? default : Elements.Of(first, writer);
            RrCallOptions options = Options(cancellation.Handle);
            nint error;
            int status = Functions.rr_generator_open(target.Native, Name(name), &elements, &options, out nint generator, &error);
            cancellation.End();
            GiveBack();
            return status == 0 ? new GeneratorHandle(generator) : throw cancellation.Failed(Failure.Take(status, error, _object.Types));
        }
    }

    private unsafe Task<T> OpenLater<T>(Func<nint, T> convert, CancellationToken cancel)
    {
        if (_object.Refusal<T>(cancel) is { } refused)
        {
            GiveBack();
            return refused;
        }
        using RemoteUse target = _object.Use();
        var completion = new TaskCompletion<T>(_object.Types, convert, cancel) { Measure = Measure.OfCall(_object, _member, _request) };
        ElementWriter? writer = _writer;
        fixed (byte* name = _member, first = writer is null ? default : writer.Written)
        {
            RrElements elements = writer is null ? default : Elements.Of(first, writer);
            RrCallOptions options = Options(completion.Cancellation);
            RrCompletion native = completion.Native;
            nint error;
            int status = Functions.rr_generator_open_async(target.Native, Name(name), &elements, &options, &native, &error);
            GiveBack();
            return status == 0 ? completion.Task : Task.FromException<T>(completion.Abandon(native, status, error));
        }
    }

    private readonly unsafe RrStr Name(byte* name) => new() { Data = name, Size = (nuint)_member.Length };

    private readonly unsafe RrCallOptions Options(nint cancellation) =>
        new() { Size = (nuint)sizeof(RrCallOptions), Access = (uint)_access, Cancellation = cancellation };

    private void GiveBack()
    {
        if (_writer is not null)
        {
            Writers.Return(_writer);
            _writer = null;
        }
    }
}
