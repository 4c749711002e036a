/* test_obj.c -- OBJ and MTL: what is read, how errors are worded, memory, and the number parser against strtod. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include "io/obj_parse.h"
#include "mesh_test.h"
#include <math.h>

/* ---- numbers ------------------------------------------------------------------------------------------------ */

static uint64_t random_bits(uint64_t *seed) /* xorshift */
{
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    return *seed;
}

static void random_token(uint64_t *seed, char *text, size_t size)
{
    uint64_t a = random_bits(seed) >> (random_bits(seed) % 64), b = random_bits(seed) >> (random_bits(seed) % 64);
    const char *sign = random_bits(seed) & 1 ? "-" : "";
    double d;
    switch (random_bits(seed) % 7) {
    case 0: /* any double, subnormal ones too */
        memcpy(&d, &a, sizeof d);
        snprintf(text, size, "%.17g ", isfinite(d) ? d : 1.5);
        break;
    case 1: snprintf(text, size, "%s%.*f ", sign, (int)(b % 20), (double)a / 1048576.0); break;
    case 2: snprintf(text, size, "%s%llu.%llu ", sign, (unsigned long long)a, (unsigned long long)b); break;
    case 3: snprintf(text, size, "%s%llue%d ", sign, (unsigned long long)a, (int)(b % 700) - 350); break;
    case 4: snprintf(text, size, "%s.%06lluE-%d ", sign, (unsigned long long)a, (int)(b % 30)); break;
    case 5: /* half way between two doubles, and just above */
        snprintf(text, size, "%s%llu%s ", sign, (unsigned long long)(2 * ((a >> 11) | (1ull << 52)) + 1),
                 b & 1 ? "" : ".0000000000000000000000000000000000001");
        break;
    default: snprintf(text, size, "%s%.17g ", sign, (double)(int64_t)(a % 4000000000u) / 1e6); break;
    }
}

static void test_numbers_as_strtod(void **state)
{
    uint64_t seed = 88172645463325252u;
    char text[128];
    (void)state;
    for (int i = 0; i < 1000000; i++) {
        random_token(&seed, text, sizeof text);
        char *want_end;
        double want = strtod(text, &want_end), got = 7;
        const char *end = gnoi_parse_number(text, &got);
        if (end != want_end || memcmp(&got, &want, sizeof got) != 0) fail_msg("\"%s\": %a is not %a", text, got, want);
    }
}

static void test_number_forms(void **state)
{
    static const struct {
        const char *text;
        int length;
        double value;
    } forms[] = {{"5\n", 1, 5},        {"+5.\n", 3, 5},      {"-.5 ", 3, -0.5},        {"1e2x", 3, 100},
                 {"1e\n", 1, 1},       {"1e+ ", 1, 1},       {"0x10", 1, 0},           {".\n", 0, 7},
                 {"-\n", 0, 7},        {"nan\n", 0, 7},      {"inf\n", 0, 7},          {"e5\n", 0, 7},
                 {"1E-2\n", 4, 0.01},  {"1e999 ", 5, INFINITY}, {"1e-999 ", 6, 0},     {"0e999999999999 ", 14, 0},
                 {"1.2.3 ", 3, 1.2},   {"1,5 ", 1, 1},       {"00000000000000000000000012 ", 26, 12}};
    (void)state;
    for (size_t i = 0; i < sizeof forms / sizeof forms[0]; i++) {
        double value = 7;
        const char *end = gnoi_parse_number(forms[i].text, &value);
        if (end - forms[i].text != forms[i].length || value != forms[i].value)
            fail_msg("%s: %g, %d characters", forms[i].text, value, (int)(end - forms[i].text));
    }
}

/* A thousand digits: a half, and the last digit decides. */
static void test_long_numbers(void **state)
{
    char text[1200];
    (void)state;
    for (int last = 0; last < 2; last++) {
        strcpy(text, "9007199254740993."); /* 2^53 + 1 */
        memset(text + 17, '0', 1000);
        text[1017] = last ? '1' : '0';
        strcpy(text + 1018, "\n");
        double value = 0;
        assert_ptr_equal(gnoi_parse_number(text, &value), text + 1018);
        assert_true(value == (last ? 9007199254740994.0 : 9007199254740992.0));
    }
    memset(text, '0', sizeof text);
    text[1] = '.';
    strcpy(text + 1100, "25e1100\n"); /* 0.000...25 with 1098 zeros */
    double value = 0;
    gnoi_parse_number(text, &value);
    assert_true(value == 25);
    memset(text, '7', 900);
    strcpy(text + 900, "e-899\n");
    gnoi_parse_number(text, &value);
    assert_true(value == strtod(text, NULL));
}

/* ---- what is read ------------------------------------------------------------------------------------------- */

static const char square[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

static void test_triangle_and_polygons(void **state)
{
    bed *b = *state;
    write_text(b, "a.obj", "# two triangles, a pentagon\nv 0 0 0\nv 1 0 0\nv 1 1 0 0.5\nv .5 1.5 0 1 0 0\nv 0 1 0\n"
                           "f 1 2 3\nf 1 2 3 4 5\nf 3 4 5\n");
    load_good(b, "a.obj", NULL);
    gno_scene_counts n = gno_scene_count(b->scene);
    assert_int_equal(n.vertices, 5);
    assert_int_equal(n.polygons, 3);
    assert_int_equal(n.corners, 11);
    assert_int_equal(b->result.polygon_count, 3);
    assert_int_equal(b->result.first_polygon, 0);
    gno_polygon p = polygon_at(b, 1);
    assert_int_equal(corner_count(&p), 5);
    check_vector(corner_at(&p, 3), 0.5, 1.5, 0, 0);
    p = polygon_at(b, 2);
    assert_int_equal(corner_count(&p), 3);
    check_vector(corner_at(&p, 0), 1, 1, 0, 0);
    assert_string_equal(b->log, "");
}

static void test_corner_forms(void **state)
{
    bed *b = *state;
    write_text(b, "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25 0.75 0.5\nvt 0.5\nvn 0 0 1\nvn 0 0 -1\nvn 1 0 0\n"
                           "f 1 2 3\nf 1/2 2/1 3/2\nf 1//3 2//2 3//1\nf 1/1/1 2/2/2 3/1/3\n"
                           "f -3/-2/-1 -2/-1/-2 -1/-2/-3\nf 1/ 2// 3/1/\n");
    load_good(b, "a.obj", NULL);
    static const int normals[6][3] = {{-1, -1, -1}, {-1, -1, -1}, {2, 1, 0}, {0, 1, 2}, {2, 1, 0}, {-1, -1, -1}};
    static const int texcoords[6][3] = {{-1, -1, -1}, {1, 0, 1}, {-1, -1, -1}, {0, 1, 0}, {0, 1, 0}, {-1, -1, 0}};
    for (size_t f = 0; f < 6; f++) {
        gno_polygon p = polygon_at(b, f);
        for (int i = 0; i < 3; i++) {
            unsigned c = p.ring_start[0] + (unsigned)i;
            assert_int_equal(p.corner_vertex[c], i);
            assert_int_equal(p.corner_normal[c], normals[f][i]);
            assert_int_equal(p.corner_texcoord[c], texcoords[f][i]);
        }
    }
    gno_polygon p = polygon_at(b, 0);
    check_near(p.texcoords[1], 0.75, 0);
    check_near(p.texcoords[2], 0.5, 0);
    check_near(p.texcoords[3], 0, 0);
    check_vector(p.normals + 6, 1, 0, 0, 0);
}

static void test_negative_and_forward_indices(void **state)
{
    bed *b = *state;
    write_text(b, "a.obj", "v 9 9 9\nf 2 3 4\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nf -3 -2 -1\n");
    load_good(b, "a.obj", NULL);
    static const int want[3][3] = {{1, 2, 3}, {1, 2, 3}, {2, 3, 4}};
    for (size_t f = 0; f < 3; f++) {
        gno_polygon p = polygon_at(b, f);
        for (unsigned i = 0; i < 3; i++) assert_int_equal(p.corner_vertex[p.ring_start[0] + i], want[f][i]);
    }
}

static void test_line_forms(void **state)
{
    bed *b = *state;
    static const char *const texts[] = {
        "v 0 0 0\r\nv 1 0 0\r\nv 1 1 0 \r\nv 0 1 0\t\r\n\r\nf 1 2 3 4\r\n",         /* CRLF */
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4",                            /* no newline at the end */
        "\tv\t0\t0 0\n  v 1   0 0\nv 1 1 0#here\nv 0 1 0 # there\\\nf 1 2 3 4#\n",    /* tabs, comments */
        "v 0 \\\n0 0\nv 1 0 0\nv 1 \\\r\n \\\n 1 0\nv 0 1 0\nf 1 2\\\n 3 \\\n4\\\n",  /* continued lines */
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\\",                          /* continued at the end of the file */
        "\xEF\xBB\xBFv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",               /* byte order mark */
        "# no \\\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ns 1\ng a \\\n b\nl 1 2\np 1\nvp 1 2\nfoo \\\nf 9\nf 1 2 3 4\n"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        write_text(b, "a.obj", texts[i]);
        load_good(b, "a.obj", NULL);
        gno_polygon p = polygon_at(b, 0);
        assert_int_equal(gno_scene_count(b->scene).vertices, 4);
        assert_int_equal(gno_scene_count(b->scene).polygons, 1);
        assert_int_equal(corner_count(&p), 4);
        check_vector(corner_at(&p, 2), 1, 1, 0, 0);
    }
}

static void test_double_precision(void **state)
{
    bed *b = *state;
    write_text(b, "a.obj", "v 4500000.1234567891 0.10000000000000001 -1e-300\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    load_good(b, "a.obj", NULL);
    gno_polygon p = polygon_at(b, 0);
    check_vector(corner_at(&p, 0), 4500000.1234567891, 0.1, -1e-300, 0);
}

/* Lines longer than the first block, and a file of many blocks with lines across their ends. */
static void test_large_files(void **state)
{
    bed *b = *state;
    size_t size = 0, room = 8000000;
    char *text = malloc(room);
    assert_non_null(text);
    size += (size_t)sprintf(text + size, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf");
    for (int i = 0; i < 300000; i++) size += (size_t)sprintf(text + size, " %d", i % 3 + 1);
    size += (size_t)sprintf(text + size, "\n");
    for (int i = 0; i < 100000; i++) size += (size_t)sprintf(text + size, "v %d.%d 1 2\nf 1 2 \\\n%d\n", i, i, i + 4);
    assert_true(size < room);
    write_bytes(b, "a.obj", text, size);
    free(text);
    load_good(b, "a.obj", NULL);
    assert_int_equal(gno_scene_count(b->scene).polygons, 100001);
    assert_int_equal(gno_scene_count(b->scene).corners, 600000);
    gno_polygon p = polygon_at(b, 100000);
    check_vector(corner_at(&p, 2), 99999.99999, 1, 2, 0);
}

static void test_short_faces_and_empty_files(void **state)
{
    bed *b = *state;
    char text[256];
    snprintf(text, sizeof text, "%svn 0 0 1\nf 1 2\nf\nf 1//1\nf 1 2 3 4\nf 1//1 2//1\nf 1 2 3\n", square);
    write_text(b, "a.obj", text);
    load_good(b, "a.obj", NULL);
    assert_int_equal(gno_scene_count(b->scene).polygons, 2);
    assert_int_equal(gno_scene_count(b->scene).corners, 7);
    assert_true(has_warning(b, "a.obj: 4 faces with less than 3 corners are skipped"));
    write_text(b, "a.obj", "");
    load_bad(b, "a.obj", GNO_ERROR_INPUT, "a.obj: holds no polygons");
    write_text(b, "a.obj", square);
    load_bad(b, "a.obj", GNO_ERROR_INPUT, "a.obj: holds no polygons");
    write_bytes(b, "a.obj", "\0\0\nf\0 1 2 3\n", 12);
    load_bad(b, "a.obj", GNO_ERROR_INPUT, "a.obj: holds no polygons");
    load_bad(b, "none.obj", GNO_ERROR_FILE, "none.obj: cannot open: No such file or directory");
}

static void test_options(void **state)
{
    bed *b = *state;
    gnoi_mesh_options options = gnoi_mesh_options_default();
    gno_material material = gno_material_default();
    char text[256];
    int red = 0;
    snprintf(text, sizeof text, "mtllib none.mtl\n%susemtl x\nf 1 2 3 4\n", square);
    write_text(b, "a.OBJ", text);
    assert_int_equal(gno_scene_add_material(b->scene, &material, &red), GNO_OK);
    options.material = red;
    options.shading = GNO_SHADING_PHONG;
    options.priority = 3;
    options.transform[3] = 10; /* move along x */
    options.transform[0] = 2;  /* after scaling it */
    assert_int_equal(load_file(b, "a.OBJ", &options), GNO_OK);
    assert_int_equal(load_file(b, "a.OBJ", &options), GNO_OK);
    assert_int_equal(b->result.first_polygon, 1);
    gno_polygon p = polygon_at(b, 1);
    assert_int_equal(p.material, red);
    assert_int_equal(p.shading, GNO_SHADING_PHONG);
    assert_int_equal(p.priority, 3);
    assert_int_equal(p.object, 1);
    check_vector(corner_at(&p, 1), 12, 0, 0, 0);
    assert_string_equal(b->log, ""); /* the file's materials are not asked for */
}

/* ---- errors ------------------------------------------------------------------------------------------------- */

static void test_error_messages(void **state)
{
    bed *b = *state;
    static const struct {
        const char *text, *message;
    } bad[] = {
        {"v 1 2 x\n", "a.obj:1: v: \"x\" is not a finite number"},
        {"v 1 2\n", "a.obj:1: v: 2 numbers, more are needed"},
        {"v\n", "a.obj:1: v: 0 numbers, more are needed"},
        {"\n# \\\nv 1 \\\nnan 3\n", "a.obj:4: v: \"nan\" is not a finite number"},
        {"v 1 2 inf\n", "a.obj:1: v: \"inf\" is not a finite number"},
        {"v 1 2 1e999\n", "a.obj:1: v: \"1e999\" is not a finite number"},
        {"v 1 2,5 3\n", "a.obj:1: v: \"2,5\" is not a finite number"},
        {"v 1 2 0x1\n", "a.obj:1: v: \"0x1\" is not a finite number"},
        {"v 0 0 0\nvn 0 0\n", "a.obj:2: vn: 2 numbers, more are needed"},
        {"v 0 0 0\r\nvt\r\n", "a.obj:2: vt: 0 numbers, more are needed"},
        {"v 0 0 0\nvn 1 0 -\n", "a.obj:2: vn: \"-\" is not a finite number"},
        {"v 0 0 0\nf 1 1 0\n", "a.obj:2: f: vertex 0: indices count from 1"},
        {"v 0 0 0\nf 1 1 -2\n", "a.obj:2: f: vertex -2 does not exist, there are 1"},
        {"v 0 0 0\nf 1 1 1\nf 1 7 1\nf 1 2 1\n", "a.obj:3: f: vertex 7 does not exist, there are 1"},
        {"v 0 0 0\nf 1 1 99999999999\n", "a.obj:2: f: \"99999999999\" is not a polygon corner"},
        {"v 0 0 0\nf 1 1 4000000000\n", "a.obj:2: f: vertex 4000000000 does not exist, there are 1"},
        {"v 0 0 0\nf 1 1 1.5\n", "a.obj:2: f: \"1.5\" is not a polygon corner"},
        {"v 0 0 0\nf 1 1 a/b\n", "a.obj:2: f: \"a/b\" is not a polygon corner"},
        {"v 0 0 0\nf 1 1 1/1/1/1\n", "a.obj:2: f: \"1/1/1/1\" is not a polygon corner"},
        {"v 0 0 0\nvt 0 0\nf 1/1 1/2 1/1\n", "a.obj:3: f: texture coordinate 2 does not exist, there are 1"},
        {"v 0 0 0\nvn 0 0 1\nf 1//1 1//1 1//-2\n", "a.obj:3: f: normal -2 does not exist, there are 1"},
        {"v 0 0 0\nf 1 1 1\nf 1//1 1//1 1//1\n", "a.obj:3: f: normal 1 does not exist, there are 0"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        write_text(b, "a.obj", bad[i].text);
        load_bad(b, "a.obj", GNO_ERROR_INPUT, bad[i].message);
    }
    write_bytes(b, "a.obj", "v 1 \0 2\n", 8);
    load_bad(b, "a.obj", GNO_ERROR_INPUT, "a.obj:1: v: \"\" is not a finite number");
}

static void test_coordinates_too_large(void **state)
{
    bed *b = *state;
    write_text(b, "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1e200 0\nf 1 2 3\n");
    assert_int_equal(load_file(b, "a.obj", NULL), GNO_ERROR_INPUT);
    assert_ptr_equal(strstr(gno_context_message(b->context), path_of(b, "a.obj: ")), gno_context_message(b->context));
}

/* ---- materials ---------------------------------------------------------------------------------------------- */

static void load_with_material(bed *b, const char *mtl)
{
    char text[256];
    snprintf(text, sizeof text, "mtllib a.mtl\n%susemtl m\nf 1 2 3 4\n", square);
    write_text(b, "a.obj", text);
    write_text(b, "a.mtl", mtl);
    load_good(b, "a.obj", NULL);
}

static void test_material_values(void **state)
{
    bed *b = *state;
    load_with_material(b, "# all\r\nnewmtl m\r\n Ka 0.1 0.2 0.3\r\n\tKd 0.4 0.5 0.6\r\nKs 0.7 0.8 0.9\r\n"
                          "Ns 25\r\nd 0.75\r\nillum 1\r\n");
    gno_material m = material_of(b, 0);
    check_vector(m.ambient, 0.1, 0.2, 0.3, 0);
    check_vector(m.diffuse, 0.4, 0.5, 0.6, 0);
    check_vector(m.specular, 0.7, 0.8, 0.9, 0);
    check_vector(m.transmission, 0.25, 0.25, 0.25, 0);
    check_near(m.shininess, 25, 0);
    assert_string_equal(gno_scene_material_name(b->scene, 1), "m");
    assert_string_equal(gno_scene_object_name(b->scene, 0), "a.obj");
    assert_int_equal(m.shading, GNO_SHADING_FLAT);
    assert_int_equal(m.two_sided, 1);
    assert_string_equal(b->log, "");
    load_with_material(b, "newmtl m\nKd 0.5\nTr 0.25\n");
    m = material_of(b, 0);
    check_vector(m.ambient, 0.5, 0.5, 0.5, 0);
    check_vector(m.diffuse, 0.5, 0.5, 0.5, 0);
    check_vector(m.specular, 0, 0, 0, 0);
    check_vector(m.transmission, 0.25, 0.25, 0.25, 0);
    load_with_material(b, "newmtl m\nKa 0 0 0\nTr 1\nd -halo 1\nTr 1");
    m = material_of(b, 0);
    check_vector(m.ambient, 0, 0, 0, 0);
    check_vector(m.diffuse, 0.8, 0.8, 0.8, 0);
    check_vector(m.transmission, 0, 0, 0, 0);
    load_with_material(b, "newmtl m\nKd 1 0 0\nd 1.5\nmap_Kd a.png\nmap_bump b.png\nbump c.png\nKs spectral f.rfl\nKd 0 1 0\n");
    m = material_of(b, 0);
    check_vector(m.diffuse, 0, 1, 0, 0);
    assert_true(has_warning(b, "a.mtl:3: d: 1.5 is taken as 1"));
    assert_true(has_warning(b, "a.mtl:7: Ks: only RGB colours are read"));
    assert_true(has_warning(b, "a.mtl:4: cannot open "));
    assert_true(has_warning(b, "c.png: No such file or directory: drawn without it"));
}

static void test_material_errors(void **state)
{
    bed *b = *state;
    static const struct {
        const char *text, *message;
    } bad[] = {
        {"Kd 1 1 1\n", "a.mtl:1: Kd: no newmtl before it"},
        {"newmtl\n", "a.mtl:1: newmtl: a name is missing"},
        {"newmtl m\nKd 1 x 1\n", "a.mtl:2: Kd: \"x\" is not a finite number"},
        {"newmtl m\nKd 1 1\n", "a.mtl:2: Kd: one or three numbers expected"},
        {"newmtl m\nKd\n", "a.mtl:2: Kd: a number is missing"},
        {"newmtl m\n\nks 0 -0.5 0\n", "a.mtl:3: Ks: -0.5 is negative"},
        {"newmtl m\nKa nan\n", "a.mtl:2: Ka: \"nan\" is not a finite number"},
        {"newmtl m\nNs -1\n", "a.mtl:2: Ns: -1 is negative"},
        {"newmtl m\nNs 1e999\n", "a.mtl:2: Ns: \"1e999\" is not a finite number"},
        {"newmtl m\nTr\n", "a.mtl:2: Tr: a number is missing"},
    };
    char text[256];
    snprintf(text, sizeof text, "mtllib a.mtl\n%sf 1 2 3 4\n", square);
    write_text(b, "a.obj", text);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        write_text(b, "a.mtl", bad[i].text);
        load_bad(b, "a.obj", GNO_ERROR_INPUT, bad[i].message);
    }
}

static void test_material_choice(void **state)
{
    bed *b = *state;
    char text[512];
    write_text(b, "one.mtl", "newmtl a\nKd 0.1 0 0\nnewmtl unused\nKd 1 1 1\n");
    write_text(b, "my two.mtl", "newmtl b c\nKd 0.2 0 0\nnewmtl a\nKd 0.3 0 0\n");
    snprintf(text, sizeof text, "%sf 1 2 3\nusemtl a\nf 1 2 3 4\nmtllib one.mtl missing.mtl\nusemtl b c \nf 1 2 3\n"
                                "usemtl a\nf 1 2 3\nusemtl nowhere\nf 1 2 3\nmtllib my two.mtl\nmtllib missing.mtl\n"
                                "usemtl\nf 1 2 3\n", square);
    write_text(b, "a.obj", text);
    load_good(b, "a.obj", NULL);
    assert_int_equal(gno_scene_count(b->scene).materials, 3); /* the default, a, b c */
    static const double red[6] = {0.8, 0.3, 0.2, 0.3, 0.8, 0.8};
    for (size_t i = 0; i < 6; i++) check_near(material_of(b, i).diffuse[0], red[i], 0);
    assert_true(has_warning(b, "a.obj:8: mtllib: cannot open /tmp/"));
    assert_null(strstr(strstr(b->log, "cannot open") + 1, "cannot open")); /* once */
    assert_true(has_warning(b, "a.obj:13: material \"nowhere\" is not defined: the default material is used"));
}

/* Many names: the table grows. */
static void test_many_materials(void **state)
{
    bed *b = *state;
    size_t room = 200000, m = 0, o = 0;
    char *mtl = malloc(room), *obj = malloc(room);
    assert_non_null(mtl);
    assert_non_null(obj);
    o += (size_t)sprintf(obj, "mtllib a.mtl\n%s", square);
    for (int i = 0; i < 3000; i++) {
        m += (size_t)sprintf(mtl + m, "newmtl m%d\nKd %d 0 0\n", i, i);
        o += (size_t)sprintf(obj + o, "usemtl m%d\nf 1 2 3\n", 2999 - i);
    }
    write_bytes(b, "a.mtl", mtl, m);
    write_bytes(b, "a.obj", obj, o);
    free(mtl);
    free(obj);
    load_good(b, "a.obj", NULL);
    for (size_t i = 0; i < 3000; i++) check_near(material_of(b, i).diffuse[0], 2999.0 - (double)i, 0);
}

/* ---- memory ------------------------------------------------------------------------------------------------- */

static void test_every_allocation_fails(void **state)
{
    bed *b = *state;
    char text[2048];
    size_t used = (size_t)snprintf(text, sizeof text, "mtllib a.mtl missing.mtl\no thing\n%svt 0 0\nvn 0 0 1\nf 1 2 3\n", square);
    for (int i = 0; i < 20; i++) /* past the arrays' first sizes */
        used += (size_t)snprintf(text + used, sizeof text - used, "v 0 0 %d\nusemtl m%d\nf 1/1/1 2/1/1 3/1/1 4/1/1\n", i, i);
    write_text(b, "a.obj", text);
    write_text(b, "a.mtl", "newmtl m0\nKd 1 1 1\nnewmtl m1\nnewmtl m2\n");
    assert_true(fail_every_allocation(path_of(b, "a.obj")) > 20);
}

/* ---- real files --------------------------------------------------------------------------------------------- */

static void test_real_files(void **state)
{
    static const struct {
        const char *name;
        size_t polygons, vertices;
    } files[] = {{"scenes/cornell_box/cornell_box.obj", 17, 76},
                 {"scenes/teapot/teapot.obj", 6320, 3644},
                 {"scenes/teapot/teapot_low.obj", 992, 792},
                 {"scenes/bunny/bunny_closed.obj", 69664, 34834},
                 {"scenes/sponza_dabrovic/sponza.obj", 66454, 60898},
                 {"scenes/city/vienna_102081.obj", 10882, 20787},
                 {"scenes/city/ingolstadt_lod3_south.obj", 30888, 22247},
                 {"scenes/building/SolarShadingTest.obj", 102, 406},
                 {"scenes/building/RefBldgMediumOfficeNew2004_Chicago.obj", 140, 560}};
    bed *b = *state;
    if (!data_file(files[0].name)) {
        printf("SKIP test_real_files: no %s under GNOMON_DATA or ../shared/data\n", files[0].name);
        skip();
    }
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        end_scene(b);
        start_scene(b);
        const char *path = data_file(files[i].name);
        assert_non_null(path);
        if (gnoi_mesh_load(b->scene, path, NULL, &b->result) != GNO_OK) fail_msg("%s", gno_context_message(b->context));
        assert_int_equal(gno_scene_count(b->scene).polygons, files[i].polygons);
        assert_int_equal(gno_scene_count(b->scene).vertices, files[i].vertices);
    }
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers_as_strtod),
        cmocka_unit_test(test_number_forms),
        cmocka_unit_test(test_long_numbers),
        TEST(test_triangle_and_polygons),
        TEST(test_corner_forms),
        TEST(test_negative_and_forward_indices),
        TEST(test_line_forms),
        TEST(test_double_precision),
        TEST(test_large_files),
        TEST(test_short_faces_and_empty_files),
        TEST(test_options),
        TEST(test_error_messages),
        TEST(test_coordinates_too_large),
        TEST(test_material_values),
        TEST(test_material_errors),
        TEST(test_material_choice),
        TEST(test_many_materials),
        TEST(test_every_allocation_fails),
        TEST(test_real_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
