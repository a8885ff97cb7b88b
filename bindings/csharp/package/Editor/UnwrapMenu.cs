#if UNITY_EDITOR
using System;
using UnityEditor;
using UnityEngine;

namespace Beltrami
{
    /// <summary>Menu items that unwrap the meshes of what is selected, and save them as
    /// assets.</summary>
    public static class UnwrapMenu
    {
        const string Textures = "Tools/Unwrap with beltrami/For textures (UV0)";
        const string Lightmaps = "Tools/Unwrap with beltrami/For lightmaps (UV1)";

        [MenuItem(Textures)]
        public static void UnwrapForTextures() { UnwrapSelection(Preset.Texturing, 0); }

        [MenuItem(Lightmaps)]
        public static void UnwrapForLightmaps() { UnwrapSelection(Preset.Lightmap, 1); }

        [MenuItem(Textures, true)]
        [MenuItem(Lightmaps, true)]
        public static bool HasSelection()
        {
            foreach (GameObject thing in Selection.gameObjects) {
                if (MeshOf(thing) != null) return true;
            }
            return false;
        }

        static void UnwrapSelection(Preset preset, int channel)
        {
            try {
                using (Context context = new Context()) {
                    context.Options.Preset = preset;
                    context.Options.Threads = Math.Max(1, SystemInfo.processorCount);
                    foreach (GameObject thing in Selection.gameObjects) {
                        if (MeshOf(thing) != null) Unwrap(thing, context, channel);
                    }
                }
            } catch (OperationCanceledException) {
                Debug.Log("beltrami: cancelled");
            } catch (Exception error) {
                if (!(error is BeltramiException) && !(error is ArgumentException)) throw;
                EditorUtility.DisplayDialog("beltrami", error.Message, "OK");
            } finally {
                EditorUtility.ClearProgressBar();
            }
        }

        static void Unwrap(GameObject thing, Context context, int channel)
        {
            Mesh mesh = UnityMeshes.Unwrapped(
                MeshOf(thing), context, channel,
                (fraction, stage) => !EditorUtility.DisplayCancelableProgressBar(
                    "beltrami", thing.name + ": " + stage, (float)fraction));
            string path = AssetDatabase.GenerateUniqueAssetPath(
                "Assets/" + (mesh.name.Length > 0 ? mesh.name : thing.name) + " unwrapped.asset");
            AssetDatabase.CreateAsset(mesh, path);
            MeshFilter filter = thing.GetComponent<MeshFilter>();
            if (filter != null) {
                Undo.RecordObject(filter, "Unwrap with beltrami");
                filter.sharedMesh = mesh;
                return;
            }
            SkinnedMeshRenderer skin = thing.GetComponent<SkinnedMeshRenderer>();
            Undo.RecordObject(skin, "Unwrap with beltrami");
            skin.sharedMesh = mesh;
        }

        static Mesh MeshOf(GameObject thing)
        {
            MeshFilter filter = thing.GetComponent<MeshFilter>();
            if (filter != null) return filter.sharedMesh;
            SkinnedMeshRenderer skin = thing.GetComponent<SkinnedMeshRenderer>();
            return skin != null ? skin.sharedMesh : null;
        }
    }
}
#endif
