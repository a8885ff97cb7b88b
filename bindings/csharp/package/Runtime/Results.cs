using System;

namespace Beltrami
{
    /// <summary>UVs of a surface: vertices split along seams, as a vertex buffer wants them, and
    /// what was found of it. All arrays are copies.</summary>
    public sealed class Atlas
    {
        /// <summary>(u, v) of each UV vertex, on its page: two numbers each.</summary>
        public float[] Uvs { get; internal set; }
        /// <summary>For each UV vertex the vertex of the surface that it is a copy of.</summary>
        public int[] Origins { get; internal set; }
        /// <summary>For each UV vertex its page, counted from 0.</summary>
        public int[] Pages { get; internal set; }
        /// <summary>For each corner its UV vertex: with Uvs an index buffer.</summary>
        public int[] UvOfCorner { get; internal set; }
        /// <summary>For each face its chart; -1 for a face without area.</summary>
        public int[] ChartOfFace { get; internal set; }
        /// <summary>Counts, energy and cost; where surfaces were unwrapped together, of all.</summary>
        public AtlasReport Report { get; internal set; }
        /// <summary>The exact verdict on these very numbers; likewise of all.</summary>
        public AtlasCertificate Certificate { get; internal set; }
        /// <summary>How the call ended: Ok, or a result with a reservation.</summary>
        public Status Status { get; internal set; }

        /// <summary>Whether no triangle is flipped, and no two overlap: proven.</summary>
        public bool Injective { get { return Certificate.Injective == 1; } }

        /// <summary>(u, v) of each corner, face after face.</summary>
        public float[] CornerUvs()
        {
            float[] uvs = new float[2 * UvOfCorner.Length];
            for (int c = 0; c < UvOfCorner.Length; ++c) {
                uvs[2 * c] = Uvs[2 * UvOfCorner[c]];
                uvs[2 * c + 1] = Uvs[2 * UvOfCorner[c] + 1];
            }
            return uvs;
        }

        /// <summary>What each UV vertex has of an array with `width` numbers for each vertex: the
        /// vertex buffer that goes with Uvs and UvOfCorner.</summary>
        public T[] Split<T>(T[] ofVertices, int width = 1)
        {
            if (ofVertices == null) throw new ArgumentNullException("ofVertices");
            T[] split = new T[Origins.Length * width];
            for (int i = 0; i < Origins.Length; ++i) {
                Array.Copy(ofVertices, Origins[i] * width, split, i * width, width);
            }
            return split;
        }
    }

    /// <summary>The map of a disk: one UV for each vertex.</summary>
    public sealed class Flattening
    {
        /// <summary>(u, v) of each vertex, in the surface's unit of length.</summary>
        public float[] Uvs { get; internal set; }
        public FlattenReport Report { get; internal set; }
        /// <summary>The exact verdict on these very numbers.</summary>
        public Certificate Certificate { get; internal set; }
        public EnergyReport Energy { get; internal set; }
        public Status Status { get; internal set; }
        /// <summary>Whether no face is flipped, and the boundary does not cross itself:
        /// proven.</summary>
        public bool Injective { get { return Certificate.Injective == 1; } }
    }
}
