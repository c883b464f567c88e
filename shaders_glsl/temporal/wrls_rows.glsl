// A model of wrls.glsl as seven texels.

struct Rows {
    vec4 row[7];
};

Rows rows_of(Model model) {
    mat4 factor = model.fit.factor;
    Rows rows;
    rows.row[0] = vec4(model.feature, model.views);
    for (int j = 0; j < 4; j += 1) rows.row[1 + j] = vec4(model.fit.slopes[j], model.fit.spread[j]);
    rows.row[5] = vec4(factor[1].x, factor[2].xy, 0.0);
    rows.row[6] = vec4(factor[3].xyz, 0.0);
    return rows;
}

Model model_of(Rows rows) {
    Model model;
    model.feature = rows.row[0].xyz;
    model.views = rows.row[0].w;
    model.fit.factor = mat4(1.0);
    for (int j = 0; j < 4; j += 1) {
        model.fit.slopes[j] = rows.row[1 + j].xyz;
        model.fit.spread[j] = rows.row[1 + j].w;
    }
    model.fit.factor[1].x = rows.row[5].x;
    model.fit.factor[2].xy = rows.row[5].yz;
    model.fit.factor[3].xyz = rows.row[6].xyz;
    return model;
}
