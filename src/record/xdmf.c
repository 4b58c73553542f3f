/* run.xdmf (run_2.xdmf ... for further groups of snapshots): tells ParaView how run.h5 is laid out (XDMF 2,
 * temporal collection of the snapshots).
 *
 * A lattice along the axes is a 3DCoRectMesh (2DCoRectMesh), any other lattice a 3DSMesh, loose points a
 * Polyvertex. XDMF counts the slowest axis first. */
#include "record/parts.h"

#include "base/safe_file.h"

static void write_escaped(FILE *out, const char *text)
{
    for (; *text != '\0'; text++)
        switch (*text) {
        case '<':
            fputs("&lt;", out);
            break;
        case '>':
            fputs("&gt;", out);
            break;
        case '&':
            fputs("&amp;", out);
            break;
        case '"':
            fputs("&quot;", out);
            break;
        default:
            fputc(*text, out);
        }
}

static void write_geometry(FILE *out, const struct snapshot_record *record)
{
    const size_t *grid = record->grid;
    if (grid[0] == 0) {
        fprintf(out, "    <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"%zu\"/>\n",
                record->points);
    } else if (record->regular) {
        fprintf(out, "    <Topology TopologyType=\"3DCoRectMesh\" Dimensions=\"%zu %zu %zu\"/>\n", grid[2],
                grid[1], grid[0]);
        const double *step = record->step;
        /* an axis without extent still needs a spacing */
        const double some = step[0] != 0.0 ? step[0] : 1.0;
        fprintf(out,
                "    <Geometry GeometryType=\"ORIGIN_DXDYDZ\">\n"
                "     <DataItem Dimensions=\"3\" Format=\"XML\">%.17g %.17g %.17g</DataItem>\n"
                "     <DataItem Dimensions=\"3\" Format=\"XML\">%.17g %.17g %.17g</DataItem>\n"
                "    </Geometry>\n",
                record->origin[2], record->origin[1], record->origin[0], step[2] != 0.0 ? step[2] : some,
                step[1] != 0.0 ? step[1] : some, some);
        return;
    } else {
        fprintf(out, "    <Topology TopologyType=\"3DSMesh\" Dimensions=\"%zu %zu %zu\"/>\n", grid[2],
                grid[1], grid[0]);
    }
    fprintf(out,
            "    <Geometry GeometryType=\"XYZ\">\n"
            "     <DataItem Dimensions=\"%zu 3\" NumberType=\"Float\" Precision=\"8\" "
            "Format=\"HDF\">run.h5:%s</DataItem>\n"
            "    </Geometry>\n",
            record->points, record->position);
}

static void write_field(FILE *out, const struct snapshot_record *record, size_t number, selas_field field)
{
    const int components = field_components(field);
    fprintf(out, "    <Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"Node\">\n", field_name(field),
            components == 1   ? "Scalar"
            : components == 3 ? "Vector"
                              : "Matrix");
    fprintf(out, "     <DataItem Dimensions=\"");
    if (record->grid[0] == 0)
        fprintf(out, "%zu", record->points);
    else
        fprintf(out, "%zu %zu %zu", record->grid[2], record->grid[1], record->grid[0]);
    if (components > 1) fprintf(out, " %d", components);
    fprintf(out,
            "\" NumberType=\"Float\" Precision=\"4\" Format=\"HDF\">run.h5:/snapshots/%04zu/%s</DataItem>\n"
            "    </Attribute>\n",
            number, field_name(field));
}

static size_t count_entries(const struct recorder *recorder, size_t group)
{
    size_t count = 0;
    for (size_t k = 0; k < recorder->entries; k++)
        count += recorder->entry[k].group == group;
    return count;
}

/* One file for each group: ParaView wants the times of a file in order. */
static selas_status write_group(const struct recorder *recorder, size_t group, struct messages *messages)
{
    const struct snapshot_record *record = &recorder->snapshot[group];
    char name[40] = "run.xdmf";
    if (group > 0) snprintf(name, sizeof name, "run_%zu.xdmf", group + 1);
    struct safe_file file;
    const selas_status status = safe_file_open(recorder->scene->output.directory, name, &file, messages);
    if (status != SELAS_OK) return status;
    FILE *out = file.file;
    fprintf(out, "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"2.0\">\n <Domain>\n  <Grid Name=\"");
    write_escaped(out, recorder->scene->title[0] != '\0' ? recorder->scene->title : "selas");
    fprintf(out, "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
    for (size_t k = 0; k < recorder->entries; k++) {
        const struct snapshot_entry *entry = &recorder->entry[k];
        if (entry->group != group) continue;
        fprintf(out, "   <Grid Name=\"%04zu\" GridType=\"Uniform\">\n    <Time Value=\"%.17g\"/>\n",
                entry->number, entry->time);
        write_geometry(out, record);
        for (int field = 0; field <= SELAS_ENERGY; field++)
            if ((record->snapshot->fields >> field & 1U) != 0)
                write_field(out, record, entry->number, (selas_field)field);
        fprintf(out, "   </Grid>\n");
    }
    fprintf(out, "  </Grid>\n </Domain>\n</Xdmf>\n");
    return safe_file_close(&file, SELAS_OK, messages);
}

selas_status xdmf_write(const struct recorder *recorder, struct messages *messages)
{
    selas_status status = SELAS_OK;
    for (size_t group = 0; group < recorder->scene->snapshots && status == SELAS_OK; group++)
        if (count_entries(recorder, group) > 0) status = write_group(recorder, group, messages);
    return status;
}
