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
    for (int j = 0; j < 4; j += 1) {
        model.fit.slopes[j] = rows.row[1 + j].xyz;
        model.fit.spread[j] = rows.row[1 + j].w;
    }
    vec4 second = vec4(rows.row[5].x, 1.0, 0.0, 0.0);
    vec4 third = vec4(rows.row[5].yz, 1.0, 0.0);
    model.fit.factor = mat4(vec4(1.0, 0.0, 0.0, 0.0), second, third, vec4(rows.row[6].xyz, 1.0));
    return model;
}
