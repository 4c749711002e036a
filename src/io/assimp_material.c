/* assimp_material.c -- the file's materials in the terms of the simple lighting model.
 *
 * Place: under assimp_mesh.c; see assimp_file.h.
 *
 * Classical materials (3DS, Collada, FBX ...): kd and ka are the diffuse colour, ks the specular colour times its
 * strength, n the shininess, transmission 1 - opacity.
 * Metallic-roughness materials (glTF): kd and ka are the base colour; ks = 0.5 (1-r)^2 in all channels and
 * n = 2/r^4 - 2, kept within [1,1000], for the roughness r: rough surfaces have no highlight, smooth ones a small strong one.
 * Transmission is 1 - opacity, where the material's alpha mode is BLEND.
 * Specular-glossiness materials: kd, ka, ks as for the classical ones, n of r = 1 - glossiness.
 * Pictures: base colour (or diffuse colour) and normals, on the first set of texture coordinates, also from within the file. Their alpha
 * makes holes where the material's alpha mode is BLEND, holes cut at its limit with MASK, none with OPAQUE.
 * All surfaces are two-sided, whatever the file says: a shadow through a wall seen from outside would surprise more.
 */
#include "assimp_file.h"
#include <assimp/cimport.h>
#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static double within(double x, double lower, double upper)
{
    return x > lower ? (x < upper ? x : upper) : lower; /* NaN: lower */
}

/* 1 where the material has the number. */
static int get_number(const struct aiMaterial *from, const char *key, unsigned type, unsigned index, double *number)
{
    ai_real value = 0;
    if (aiGetMaterialFloatArray(from, key, type, index, &value, NULL) != aiReturn_SUCCESS) return 0;
    *number = (double)value;
    return 1;
}

static int get_colour(const struct aiMaterial *from, const char *key, unsigned type, unsigned index, double colour[3])
{
    struct aiColor4D value;
    if (aiGetMaterialColor(from, key, type, index, &value) != aiReturn_SUCCESS) return 0;
    colour[0] = within((double)value.r, 0, 1e6);
    colour[1] = within((double)value.g, 0, 1e6);
    colour[2] = within((double)value.b, 0, 1e6);
    return 1;
}

static int blends(const struct aiMaterial *from)
{
    struct aiString mode;
    if (aiGetMaterialString(from, AI_MATKEY_GLTF_ALPHAMODE, &mode) != aiReturn_SUCCESS) return 0;
    return strcmp(mode.data, "BLEND") == 0;
}

static gnoi_alpha_use alpha_use(const struct aiMaterial *from, int is_gltf, double *limit)
{
    struct aiString mode;
    *limit = 0.5;
    if (!is_gltf) return GNOI_ALPHA_KEEP;
    if (aiGetMaterialString(from, AI_MATKEY_GLTF_ALPHAMODE, &mode) != aiReturn_SUCCESS) return GNOI_ALPHA_DROP;
    if (strcmp(mode.data, "MASK") == 0) {
        get_number(from, AI_MATKEY_GLTF_ALPHACUTOFF, limit);
        return GNOI_ALPHA_CUT;
    }
    return strcmp(mode.data, "BLEND") == 0 ? GNOI_ALPHA_KEEP : GNOI_ALPHA_DROP;
}

static double shininess_of_roughness(double roughness)
{
    double r2 = roughness * roughness;
    return r2 > 0 ? within(2 / (r2 * r2) - 2, 1, 1000) : 1000;
}

static void set_highlight(const struct aiMaterial *from, gno_material *to)
{
    double roughness = 1, gloss = 0, strength = 1;
    if (get_number(from, AI_MATKEY_GLOSSINESS_FACTOR, &gloss)) {
        get_colour(from, AI_MATKEY_COLOR_SPECULAR, to->specular);
        to->shininess = shininess_of_roughness(1 - within(gloss, 0, 1));
    } else if (get_number(from, AI_MATKEY_ROUGHNESS_FACTOR, &roughness)) {
        double smooth = 1 - within(roughness, 0, 1);
        to->specular[0] = to->specular[1] = to->specular[2] = 0.5 * smooth * smooth;
        to->shininess = shininess_of_roughness(1 - smooth);
    } else {
        get_colour(from, AI_MATKEY_COLOR_SPECULAR, to->specular);
        get_number(from, AI_MATKEY_SHININESS_STRENGTH, &strength);
        for (int i = 0; i < 3; i++) to->specular[i] *= within(strength, 0, 1e6);
        if (get_number(from, AI_MATKEY_SHININESS, &to->shininess)) to->shininess = within(to->shininess, 0, 1e6);
    }
}

static gno_material convert(const struct aiMaterial *from, int is_gltf)
{
    gno_material to = gno_material_default();
    double gloss = 0, opacity = 1;
    int has_gloss = get_number(from, AI_MATKEY_GLOSSINESS_FACTOR, &gloss);
    if (has_gloss || !get_colour(from, AI_MATKEY_BASE_COLOR, to.diffuse)) get_colour(from, AI_MATKEY_COLOR_DIFFUSE, to.diffuse);
    memcpy(to.ambient, to.diffuse, sizeof to.ambient);
    set_highlight(from, &to);
    if (get_number(from, AI_MATKEY_OPACITY, &opacity) && (!is_gltf || blends(from)))
        to.transmission[0] = to.transmission[1] = to.transmission[2] = 1 - within(opacity, 0, 1);
    return to;
}

/* ---- pictures --------------------------------------------------------------------------------------------------------------- */

static gno_wrap wrap_of(enum aiTextureMapMode mode)
{
    switch (mode) {
    case aiTextureMapMode_Clamp: return GNO_WRAP_CLAMP;
    case aiTextureMapMode_Mirror: return GNO_WRAP_MIRROR;
    case aiTextureMapMode_Decal: return GNO_WRAP_NONE;
    default: return GNO_WRAP_REPEAT;
    }
}

/* A picture within the file, named "*3" by its number or by its own name; NULL: it is a file of its own. */
static const struct aiTexture *find_embedded(const gnoi_assimp *a, const char *name)
{
    const struct aiScene *file = a->file;
    if (name[0] == '*') {
        unsigned long number = strtoul(name + 1, NULL, 10);
        return number < file->mNumTextures ? file->mTextures[number] : NULL;
    }
    for (unsigned i = 0; i < file->mNumTextures; i++)
        if (file->mTextures[i]->mFilename.length > 0 && strcmp(file->mTextures[i]->mFilename.data, name) == 0) return file->mTextures[i];
    return NULL;
}

/* texture->kind stays none where the material has no such picture, or one that cannot be read: a warning. */
static gno_status get_picture(gnoi_assimp *a, const struct aiMaterial *from, enum aiTextureType type, gnoi_texture_request *request,
                              gno_texture *texture)
{
    char reason[GNOI_TEXTURE_REASON];
    struct aiString path;
    enum aiTextureMapMode modes[2] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
    const struct aiTexture *embedded;
    unsigned channel = 0;
    int image;
    if (aiGetMaterialTextureCount(from, type) == 0 ||
        aiGetMaterialTexture(from, type, 0, &path, NULL, &channel, NULL, NULL, modes, NULL) != aiReturn_SUCCESS)
        return GNO_OK;
    embedded = find_embedded(a, path.data);
    request->beside = a->path;
    request->name = path.data;
    if (embedded && embedded->mHeight != 0) {
        gnoi_mesh_warn(a->context, a->path, 0, "texture %.200s lies in the file without compression: drawn without it", path.data);
        return GNO_OK;
    }
    if (embedded) {
        request->data = embedded->pcData;
        request->data_size = embedded->mWidth;
    }
    if (channel != 0) {
        gnoi_mesh_warn(a->context, a->path, 0, "texture %.200s lies on a second set of texture coordinates: drawn without it", path.data);
        return GNO_OK;
    }
    gno_status status = gnoi_textures_get(&a->textures, request, &image, reason);
    if (status != GNO_OK) return status;
    if (reason[0]) gnoi_mesh_warn(a->context, a->path, 0, "%s: drawn without it", reason);
    if (image < 0) return GNO_OK;
    texture->kind = GNO_TEXTURE_IMAGE;
    texture->image = image;
    texture->wrap = wrap_of(modes[0]);
    if (modes[1] != modes[0])
        gnoi_mesh_warn(a->context, a->path, 0, "texture %.200s repeats otherwise upwards than across: drawn as across", path.data);
    return GNO_OK;
}

static gno_status set_pictures(gnoi_assimp *a, const struct aiMaterial *from, gno_material *to)
{
    gnoi_texture_request colour, relief;
    memset(&colour, 0, sizeof colour);
    memset(&relief, 0, sizeof relief);
    colour.is_colour = 1;
    colour.alpha = alpha_use(from, a->is_gltf, &colour.limit);
    gno_status status = get_picture(a, from, aiTextureType_BASE_COLOR, &colour, &to->texture);
    if (status == GNO_OK && to->texture.kind == GNO_TEXTURE_NONE) status = get_picture(a, from, aiTextureType_DIFFUSE, &colour, &to->texture);
    relief.alpha = GNOI_ALPHA_DROP;
    if (status == GNO_OK) status = get_picture(a, from, aiTextureType_NORMALS, &relief, &to->bump.texture);
    if (status != GNO_OK || to->bump.texture.kind == GNO_TEXTURE_NONE) return status;
    to->bump.kind = GNO_BUMP_NORMAL;
    get_number(from, AI_MATKEY_GLTF_TEXTURE_SCALE(aiTextureType_NORMALS, 0), &to->bump.amount);
    return GNO_OK;
}

/* assimp makes up a material of this name where the file has none. */
static int is_made_up(const struct aiMaterial *from)
{
    struct aiString name;
    if (aiGetMaterialString(from, AI_MATKEY_NAME, &name) != aiReturn_SUCCESS) return 0;
    return strcmp(name.data, AI_DEFAULT_MATERIAL_NAME) == 0;
}

int gnoi_assimp_material(gnoi_assimp *a, unsigned number, gno_status *status)
{
    if (number >= a->file->mNumMaterials || a->is_geometry) return 0;
    if (a->material_index[number] >= 0) return a->material_index[number];
    const struct aiMaterial *from = a->file->mMaterials[number];
    if (is_made_up(from)) return 0;
    gno_material material = convert(from, a->is_gltf);
    struct aiString name;
    *status = set_pictures(a, from, &material);
    if (*status != GNO_OK) return -1;
    *status = gno_scene_add_material(a->scene, &material, &a->material_index[number]);
    if (*status == GNO_OK && aiGetMaterialString(from, AI_MATKEY_NAME, &name) == aiReturn_SUCCESS)
        *status = gno_scene_set_material_name(a->scene, a->material_index[number], name.data);
    if (*status != GNO_OK) {
        *status = gnoi_mesh_blame(a->scene, a->path, *status);
        return -1;
    }
    return a->material_index[number];
}
