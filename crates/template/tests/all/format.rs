//! What a wrong template file says, and where.

use template::{Reference, RegenerateOptions, Template, TemplateError, regenerate};

use super::model;

const GOOD: &str = r#"{ "toile_template": 1, "name": "flap", "level": 1,
  "nodes": { "a": { "at": "origin" }, "b": { "at": "origin", "axes": [100, 0, 0] }, "c": { "at": "origin", "axes": [0, 100, 0] } },
  "surfaces": { "flap": { "faces": [["a", "b", "c"]] } },
  "lines": { "edge": { "through": ["a", "b"] } } }"#;

fn error(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from}");
    Template::from_json(&GOOD.replacen(from, to, 1)).unwrap_err().to_string()
}

#[test]
fn a_list_is_no_template() {
    for text in ["[]", "[1, \"flap\", 1]"] {
        let said = Template::from_json(text).unwrap_err().to_string();
        assert!(
            said.starts_with("template: this is a list; an object") && said.contains("toile_template"),
            "{said}"
        );
    }
}

#[test]
fn errors_name_the_place() {
    let cases = [
        (r#""name""#, r#""nmae""#, "nmae"),
        (r#""level": 1"#, r#""level": 99"#, "level: 99 splits"),
        (r#""level": 1"#, r#""level": "high""#, "level: "),
        (r#"[100, 0, 0]"#, r#"[100, 0]"#, "nodes.b.axes"),
        (r#""axes": [100, 0, 0]"#, r#""axis": [100, 0, 0]"#, "nodes.b.axis"),
        (r#""a": { "at": "origin" }"#, r#""a": { "normal": 3 }"#, "nodes.a: give `at`"),
        (r#""a": { "at": "origin" }"#, r#""a": { "at": "origin", "ease": "bust" }"#, "nodes.a.ease"),
        (
            r#""a": { "at": "origin" }"#,
            r#""a": { "at": "origin" }, "a": { "at": "origin" }"#,
            "nodes.a: the key `a` is given twice",
        ),
        (
            r#"["a", "b", "c"]"#,
            r#"["a", "b", "cc"]"#,
            "surfaces.flap.faces[0]: there is no node `cc`; did you mean `c`?",
        ),
        (r#"{ "at": "origin" }, "b""#, r#"["origin"], "b""#, "nodes.a: this is a list; an object"),
        (r#"["a", "b", "c"]"#, r#"["a", "b"]"#, "surfaces.flap.faces[0]"),
        (r#"["a", "b"] }"#, r#"["a"] }"#, "lines.edge.through"),
        (r#"["a", "b"] }"#, r#"["a", "b"], "shape": "wavy" }"#, "lines.edge.shape"),
        (r#""toile_template": 1"#, r#""toile_template": 7"#, "version 7"),
        (r#""lines""#, r#""ease": { "bust": { "ease": 1e9 } }, "lines""#, "ease.bust.ease"),
    ];
    for (from, to, expected) in cases {
        let message = error(from, to);
        assert!(message.contains(expected), "`{message}` does not say `{expected}`");
    }
    assert!(Template::from_json("{").unwrap_err().to_string().contains("EOF"));
}

#[test]
fn errors_that_need_a_body() {
    let (mesh, features) = model::nothing();
    let reference = Reference { mesh: &mesh, features: &features };
    let build = |text: &str| {
        regenerate(&Template::from_json(text).unwrap(), &reference, &RegenerateOptions::default())
    };
    assert!(build(GOOD).is_ok());
    let unknown = build(&GOOD.replacen(r#""a": { "at": "origin" }"#, r#""a": { "at": "navel" }"#, 1));
    assert!(matches!(unknown, Err(TemplateError::UnknownFeature { ref path, .. }) if path == "nodes.a.at"));
    let edge = build(
        &GOOD
            .replacen(r#""surfaces""#, r#""fair_across": [], "surfaces""#, 1)
            .replacen(
                r#"{ "through": ["a", "b"] }"#,
                r#"{ "through": ["a", "b"] }, "far": { "through": ["d", "a"] }"#,
                1,
            )
            .replacen(r#""nodes": {"#, r#""nodes": { "d": { "at": "origin", "axes": [-50, 0, 0] },"#, 1),
    );
    assert!(
        edge.unwrap_err().to_string().contains("lines.far.through: no surface has an edge from `a` to `d`")
    );
    let three = build(&GOOD.replacen(
        r#"[["a", "b", "c"]]"#,
        r#"[["a", "b", "c"], ["b", "a", "d"], ["a", "b", "e"]]"#,
        1,
    ).replacen(r#""nodes": {"#, r#""nodes": { "d": { "at": "origin", "axes": [0, -50, 0] }, "e": { "at": "origin", "axes": [0, 0, 50] },"#, 1));
    assert!(matches!(three, Err(TemplateError::BadSurface { .. })), "{three:?}");
    let mut holed = mesh.clone();
    holed.positions[3].x = f64::NAN;
    let reference = Reference { mesh: &holed, features: &features };
    let nan = regenerate(&Template::from_json(GOOD).unwrap(), &reference, &RegenerateOptions::default());
    assert!(matches!(nan, Err(TemplateError::BadReference(_))));
}

#[test]
fn a_template_written_and_read_is_the_same() {
    let template = super::collision::skirt(10.0, 50.0);
    let again = Template::from_json(&template.to_json()).unwrap();
    assert_eq!(template.file(), again.file());
    let schema = Template::schema();
    assert!(schema["properties"]["nodes"].is_object());
    // A circle of `between`.
    let circle = GOOD.replacen(
        r#""a": { "at": "origin" }"#,
        r#""a": { "between": ["b", "x"] }, "x": { "between": ["a", "b"] }"#,
        1,
    );
    let (mesh, features) = model::nothing();
    let reference = Reference { mesh: &mesh, features: &features };
    let built = regenerate(&Template::from_json(&circle).unwrap(), &reference, &RegenerateOptions::default());
    assert!(built.unwrap_err().to_string().contains("circle"));
}
