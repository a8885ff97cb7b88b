using System;
using System.Collections.Generic;
using System.Runtime.ExceptionServices;
using System.Runtime.InteropServices;
using System.Threading;

namespace Beltrami
{
    /// <summary>Names what native code calls: compilers to native code look for this name.</summary>
    [AttributeUsage(AttributeTargets.Method)]
    internal sealed class MonoPInvokeCallbackAttribute : Attribute
    {
        public MonoPInvokeCallbackAttribute(Type type) { }
    }

    /// <summary>Options by name or key; the properties are of the same ones.</summary>
    public sealed unsafe partial class Options
    {
        readonly Context context;

        internal Options(Context context) { this.context = context; }

        /// <summary>Sets an option by the name that it has in the program, such as
        /// "target-energy"; of a choice to the number of its value.</summary>
        public Options Set(string name, double value)
        {
            int key = Native.beltrami_option_find(name);
            if (key < 0) throw new ArgumentException("there is no option " + name);
            NativeOptionInfo info = new NativeOptionInfo();
            info.StructSize = Context.SizeOf<NativeOptionInfo>();
            Native.beltrami_option_describe(key, &info);
            if ((OptionType)info.Type == OptionType.Float) SetFloat((Option)key, value);
            else SetInt((Option)key, checked((long)value));
            return this;
        }

        /// <summary>Sets a choice by the names that it and its value have in the program, such as
        /// "effort" and "quick".</summary>
        public Options Set(string name, string choice)
        {
            int key = Native.beltrami_option_find(name);
            if (key < 0) throw new ArgumentException("there is no option " + name);
            for (int value = 0;; ++value) {
                IntPtr known = Native.beltrami_option_choice(key, value);
                if (known == IntPtr.Zero) {
                    throw new ArgumentException("the option " + name + " has no choice " + choice);
                }
                if (BeltramiException.Text(known) != choice) continue;
                SetInt((Option)key, value);
                return this;
            }
        }

        double Get(Option option)
        {
            double value;
            context.Check(Native.beltrami_get_option(context.Handle, (int)option, &value));
            return value;
        }

        void SetInt(Option option, long value)
        {
            context.Check(Native.beltrami_set_int(context.Handle, (int)option, value));
        }

        void SetFloat(Option option, double value)
        {
            context.Check(Native.beltrami_set_float(context.Handle, (int)option, value));
        }
    }

    /// <summary>Options, and the calls that take them. One thread at a time may use a context;
    /// contexts share nothing.</summary>
    public sealed unsafe class Context : IDisposable
    {
        static readonly Progress toldProgress = Told, refusedProgress = Refuse;
        IntPtr handle;

        public Context()
        {
            IntPtr created;
            Status status = Native.beltrami_create_(Native.Abi, &created);
            if (status < 0) {
                string advice = BeltramiException.Text(Native.beltrami_status_advice(status));
                throw new BeltramiException(status, advice, ElementKind.None, Native.NoElement);
            }
            handle = created;
            Options = new Options(this);
        }

        ~Context() { Native.beltrami_destroy(handle); }

        public void Dispose()
        {
            Native.beltrami_destroy(handle);
            handle = IntPtr.Zero;
            GC.SuppressFinalize(this);
        }

        public Options Options { get; private set; }

        /// <summary>The context of the C interface, for calls of <see cref="Native"/>.</summary>
        public IntPtr Handle
        {
            get
            {
                if (handle == IntPtr.Zero) throw new ObjectDisposedException("Context");
                return handle;
            }
        }

        /// <summary>One line on the build of the library.</summary>
        public static string BuildInfo
        {
            get { return BeltramiException.Text(Native.beltrami_build_info()); }
        }

        /// <summary>Cuts any surface into charts, flattens and packs them. `progress` is told a
        /// fraction and a stage on this thread, and cancels by false; `cancel` from any thread.
        /// Throws BeltramiException, OperationCanceledException, and what `progress`
        /// throws.</summary>
        public Atlas Unwrap(Surface surface, Func<double, string, bool> progress = null,
                            CancellationToken cancel = default(CancellationToken))
        {
            return UnwrapTogether(new[] { surface }, progress, cancel)[0];
        }

        /// <summary>The same for several surfaces, whose charts share pages at one scale. Each has
        /// an atlas in its own numbers.</summary>
        public Atlas[] UnwrapTogether(IList<Surface> surfaces,
                                      Func<double, string, bool> progress = null,
                                      CancellationToken cancel = default(CancellationToken))
        {
            if (surfaces == null) throw new ArgumentNullException("surfaces");
            if (surfaces.Count == 0) throw new ArgumentException("give one surface or more");
            Status status;
            using (Held held = new Held())
            using (Cancelling number = new Cancelling(held, cancel)) {
                NativeSurface[] described = new NativeSurface[surfaces.Count];
                for (int i = 0; i < described.Length; ++i) {
                    if (surfaces[i] == null) throw new ArgumentNullException("surfaces");
                    described[i] = surfaces[i].Describe(held, number.Memory);
                }
                NativeSurface* first = (NativeSurface*)held.Pin(described);
                IntPtr[] pointers = new IntPtr[described.Length];
                for (int i = 0; i < pointers.Length; ++i) pointers[i] = (IntPtr)(first + i);
                NativeSurface** all = (NativeSurface**)held.Pin(pointers);
                status = Run(progress, cancel, (function, user) => Native.beltrami_unwrap_surfaces(
                    Handle, all, (ulong)pointers.Length, function, user));
            }
            return ReadAtlases(surfaces, status);
        }

        /// <summary>Flattens triangles that form one disk: one UV for each vertex.</summary>
        public Flattening Flatten(Surface disk, Func<double, string, bool> progress = null,
                                  CancellationToken cancel = default(CancellationToken))
        {
            if (disk == null) throw new ArgumentNullException("disk");
            Status status;
            using (Held held = new Held())
            using (Cancelling number = new Cancelling(held, cancel)) {
                NativeMesh mesh = disk.DescribeDisk(held, number.Memory);
                Status taken = Native.beltrami_set_mesh(Handle, &mesh);
                if (taken == Status.ECancelled) cancel.ThrowIfCancellationRequested();
                Check(taken);
                try {
                    using (cancel.Register(() => Native.beltrami_cancel(handle))) {
                        status = Run(progress, cancel, (function, user) => Native.beltrami_run(
                            Handle, function, user));
                    }
                } finally {
                    // A request that came too late for this run is not meant for the next one.
                    if (cancel.IsCancellationRequested) {
                        Native.beltrami_run(Handle, refusedProgress, IntPtr.Zero);
                    }
                }
            }
            float[] uvs = new float[2 * disk.VertexCount];
            FlattenReport report = new FlattenReport { StructSize = SizeOf<FlattenReport>() };
            Certificate certificate = new Certificate { StructSize = SizeOf<Certificate>() };
            EnergyReport energy = new EnergyReport { StructSize = SizeOf<EnergyReport>() };
            fixed (float* to = uvs) {
                Check(Native.beltrami_get_uvs(Handle, (IntPtr)to, (int)Scalar.F32, 0));
            }
            Check(Native.beltrami_get_result(Handle, &report));
            Check(Native.beltrami_get_float32_certificate(Handle, &certificate));
            Check(Native.beltrami_get_energy(Handle, &energy));
            return new Flattening
            {
                Uvs = uvs, Report = report, Certificate = certificate, Energy = energy,
                Status = status
            };
        }

        /// <summary>Judges the CornerUvs of a surface, from anywhere, by exact predicates.
        /// `allowMirrored` takes charts that are negative as a whole for their mirror
        /// images.</summary>
        public static AtlasCertificate CheckAtlas(Surface surface, bool allowMirrored = false)
        {
            if (surface == null) throw new ArgumentNullException("surface");
            AtlasCertificate found = new AtlasCertificate { StructSize = SizeOf<AtlasCertificate>() };
            using (Held held = new Held()) {
                NativeSurface described = surface.Describe(held, IntPtr.Zero);
                Status status = Native.beltrami_check_atlas(
                    &described, allowMirrored ? 1 : 0, &found, null, 0);
                if (status >= 0) return found;
                string advice = BeltramiException.Text(Native.beltrami_status_advice(status));
                throw new BeltramiException(status, advice, (ElementKind)found.ErrorElementKind,
                                            found.ErrorElement);
            }
        }

        internal static uint SizeOf<T>() { return (uint)Marshal.SizeOf(typeof(T)); }

        internal void Check(Status status) { BeltramiException.ThrowIfFailed(status, Handle); }

        // ---- Calls that report progress ----

        /// <summary>A number in memory that the library looks at, set by a token.</summary>
        sealed class Cancelling : IDisposable
        {
            readonly int[] number = new int[1];
            CancellationTokenRegistration registration;

            public Cancelling(Held held, CancellationToken token)
            {
                Memory = held.Pin(number);
                registration = token.Register(() => Volatile.Write(ref number[0], 1));
            }

            public IntPtr Memory { get; private set; }

            public void Dispose() { registration.Dispose(); }
        }

        sealed class Running
        {
            public Func<double, string, bool> Progress;
            public ExceptionDispatchInfo Raised;
            public bool Refused;
        }

        delegate Status Call(Progress function, IntPtr user);

        [MonoPInvokeCallback(typeof(Progress))]
        static int Told(IntPtr user, double fraction, IntPtr stage)
        {
            Running running = (Running)GCHandle.FromIntPtr(user).Target;
            try {
                running.Refused =
                    !running.Progress(fraction, BeltramiException.Text(stage)) || running.Refused;
            } catch (Exception raised) {  // which cannot pass through the library
                running.Raised = ExceptionDispatchInfo.Capture(raised);
                running.Refused = true;
            }
            return running.Refused ? 1 : 0;
        }

        [MonoPInvokeCallback(typeof(Progress))]
        static int Refuse(IntPtr user, double fraction, IntPtr stage) { return 1; }

        Status Run(Func<double, string, bool> progress, CancellationToken cancel, Call call)
        {
            Running running = new Running { Progress = progress };
            GCHandle user = GCHandle.Alloc(running);
            Status status;
            try {
                status = call(progress == null ? null : toldProgress, GCHandle.ToIntPtr(user));
            } finally {
                user.Free();
            }
            if (running.Raised != null) running.Raised.Throw();
            if (status == Status.ECancelled) {
                cancel.ThrowIfCancellationRequested();
                throw new OperationCanceledException("progress has cancelled the call");
            }
            Check(status);
            return status;
        }

        // ---- Results ----

        delegate Status Getter(IntPtr context, IntPtr room, int type, ulong stride);

        int[] Integers(ulong count, Getter get)
        {
            int[] numbers = new int[checked((int)count)];
            int[] room = numbers.Length > 0 ? numbers : new int[1];
            fixed (int* to = room) Check(get(Handle, (IntPtr)to, (int)Scalar.U32, 0));
            return numbers;
        }

        Atlas[] ReadAtlases(IList<Surface> surfaces, Status status)
        {
            AtlasReport report = new AtlasReport { StructSize = SizeOf<AtlasReport>() };
            Check(Native.beltrami_get_atlas(Handle, &report));
            AtlasCertificate certificate = new AtlasCertificate();
            certificate.StructSize = SizeOf<AtlasCertificate>();
            Check(Native.beltrami_get_atlas_certificate(Handle, (int)Scalar.F32, &certificate));
            float[] uvs = new float[checked(2 * (int)report.UvVertices)];
            fixed (float* to = uvs) {
                Check(Native.beltrami_get_uv_vertices(Handle, (IntPtr)to, (int)Scalar.F32, 0));
            }
            int[] uvOfCorner = Integers(report.Corners, Native.beltrami_get_corner_uv_vertices);
            int[] pageOfCorner = Integers(report.Corners, Native.beltrami_get_corner_pages);
            int[] origins = Integers(report.UvVertices, Native.beltrami_get_uv_vertex_origins);
            int[] charts = Integers(report.Faces, Native.beltrami_get_face_charts);
            Atlas[] atlases = new Atlas[surfaces.Count];
            long vertex = 0, face = 0, corner = 0, uv = 0;
            for (int i = 0; i < atlases.Length; ++i) {
                long corners = surfaces[i].CornerCount, faces = surfaces[i].FaceCount;
                long end = vertex + surfaces[i].VertexCount, uvEnd = uv;
                while (uvEnd < origins.Length && origins[uvEnd] < end) ++uvEnd;
                int[] pages = new int[uvEnd - uv];
                for (long c = corner; c < corner + corners; ++c) {
                    pages[uvOfCorner[c] - uv] = pageOfCorner[c];
                }
                atlases[i] = new Atlas
                {
                    Uvs = Part(uvs, 2 * uv, 2 * (uvEnd - uv)),
                    Origins = Less(Part(origins, uv, uvEnd - uv), (int)vertex),
                    Pages = pages,
                    UvOfCorner = Less(Part(uvOfCorner, corner, corners), (int)uv),
                    ChartOfFace = Part(charts, face, faces),
                    Report = report, Certificate = certificate, Status = status
                };
                vertex = end;
                face += faces;
                corner += corners;
                uv = uvEnd;
            }
            return atlases;
        }

        static T[] Part<T>(T[] all, long first, long count)
        {
            if (first == 0 && count == all.Length) return all;
            T[] part = new T[count];
            Array.Copy(all, first, part, 0, count);
            return part;
        }

        static int[] Less(int[] numbers, int before)
        {
            for (int i = 0; i < numbers.Length; ++i) numbers[i] -= before;
            return numbers;
        }
    }
}
