//! Edits of a specification change only the edited text.

use eomgen_model_spec::edit::{
    Edit, EditError, NewCoordinate, NewForce, NewParameter, NewState, NewTerm, NewValue, Section,
    SetParameter, Substitution, apply,
};
use eomgen_model_spec::source::Source;

const SPRING: &str = r#"# A mass on a spring with play.

[model]
name = "spring"        # and no title

[parameters]
# the usual ones
m = { value = 2.0, unit = "kg" }   # moved
k = { value = 300, unit = 'N/m', doc = "stiffness" }
b = { value = 10,  unit = "mm" }

[coordinates]
y = { unit = "m" }

[kinetic]
mass = "1/2*m*dot(y)^2"
[potential]
spring = "1/2*k*deadzone( y , b )^2"   # Eq. (7)

# end of file
"#;

fn source() -> Source {
    Source::new("spring.toml", SPRING)
}

fn text(text: &str) -> String {
    text.to_owned()
}

fn force() -> Edit {
    Edit::AddForce(NewForce {
        name: text("friction"),
        on: text("y"),
        value: text("-T_c*sign(dot(y))"),
        doc: text("dry friction"),
        source: text("fitted"),
    })
}

fn parameter() -> Edit {
    Edit::AddParameter(NewParameter {
        name: text("T_c"),
        value: NewValue::Number(0.8e-6),
        unit: text("N"),
        doc: text("dry \"friction\""),
        source: String::new(),
    })
}

/// Returns the lines of `edited` that `SPRING` does not have; all other lines must match in
/// order.
fn added_lines(edited: &str) -> Vec<String> {
    let mut original = SPRING.lines().peekable();
    let mut added = Vec::new();
    for line in edited.lines() {
        if original.peek() == Some(&line) {
            original.next();
        } else {
            added.push(line.to_owned());
        }
    }
    assert_eq!(original.next(), None, "a line is missing in\n{edited}");
    added
}

#[test]
fn added_source_of_a_parameter_has_no_space_before_its_comma() {
    let edit = Edit::SetParameter(SetParameter {
        name: text("k"),
        value: 310.0,
        source: text("fitted"),
    });
    let edited = apply(&source(), &[edit]).expect("valid");
    let expected = SPRING.replace(
        "k = { value = 300, unit = 'N/m', doc = \"stiffness\" }",
        "k = { value = 310.0, unit = 'N/m', doc = \"stiffness\", source = \"fitted\" }",
    );
    assert_eq!(edited, expected);
}

#[test]
fn additions_keep_every_line() {
    let edited = apply(&source(), &[parameter(), force()]).expect("valid");
    let expected = [
        "T_c = { value = 8e-7, unit = \"N\", doc = 'dry \"friction\"' }",
        "",
        "[forces]",
        "friction = { on = \"y\", value = \"-T_c*sign(dot(y))\", doc = \"dry friction\", \
         source = \"fitted\" }",
    ];
    assert_eq!(added_lines(&edited), expected);
    assert!(edited.find("T_c =") < edited.find("[coordinates]"));
}

#[test]
fn terms_and_coordinates_are_added_to_their_sections() {
    let coordinate = Edit::AddCoordinate(NewCoordinate {
        name: text("z"),
        unit: text("m"),
        doc: String::new(),
        initial: Some(NewValue::Expression(text("2*b"))),
    });
    let term = |section, name, value| {
        Edit::AddTerm(NewTerm {
            section,
            name: text(name),
            value: text(value),
            doc: String::new(),
            source: String::new(),
        })
    };
    let definition = term(Section::Definitions, "gap", "z - y");
    let kinetic = term(Section::Kinetic, "second", "1/2*m*dot(z)^2");
    let potential = term(Section::Potential, "between", "1/2*k*gap^2");
    let edits = [coordinate, definition, kinetic, potential];
    let edited = apply(&source(), &edits).expect("valid");
    let expected = [
        "z = { unit = \"m\", initial = \"2*b\" }",
        "second = \"1/2*m*dot(z)^2\"",
        "between = \"1/2*k*gap^2\"",
        "",
        "[definitions]",
        "gap = \"z - y\"",
    ];
    assert_eq!(added_lines(&edited), expected);
}

#[test]
fn added_state_replaces_an_input() {
    let drive = "[inputs]\nu = { unit = \"N\" }\n\n[states]\nF = { unit = \"N\", rate = \"(u - F)/tau\" }\n\n\
                 [forces]\npull = { on = \"y\", value = \"F + u\" }\n";
    let tau = "tau = { value = 0.1, unit = \"s\" }\n\n[coordinates]";
    let driven = SPRING.replacen("[coordinates]", tau, 1) + drive;
    let source = Source::new("driven.toml", driven.as_str());
    let state = Edit::AddState(NewState {
        name: text("acting"),
        unit: text("N"),
        rate: text("(u - acting)/tau"),
        doc: String::new(),
    });
    let substitute = |section, term| {
        Edit::Substitute(Substitution {
            section,
            terms: vec![text(term)],
            find: text("u"),
            replace: text("acting"),
        })
    };
    let edits = [
        state,
        substitute(Section::States, "F"),
        substitute(Section::Forces, "pull"),
    ];
    let edited = apply(&source, &edits).expect("valid");
    for line in [
        "F = { unit = \"N\", rate = \"(acting - F)/tau\" }",
        "acting = { unit = \"N\", rate = \"(u - acting)/tau\" }",
        "pull = { on = \"y\", value = \"F + acting\" }",
    ] {
        assert!(edited.lines().any(|own| own == line), "{line}: {edited}");
    }
}

#[test]
fn substitution_changes_only_the_matching_text() {
    let substitute = |find, replace| {
        Edit::Substitute(Substitution {
            section: Section::Potential,
            terms: vec![text("spring")],
            find: text(find),
            replace: text(replace),
        })
    };
    let edited = |find, replace| apply(&source(), &[substitute(find, replace)]);
    let shifted = edited("deadzone(y, b)", "deadzone(y - b/2, b)").expect("valid");
    let expected = SPRING.replace("deadzone( y , b )", "deadzone(y - b/2, b)");
    assert_eq!(shifted, expected);
    let argument = edited("y", "y - b/2").expect("valid");
    assert_eq!(
        argument,
        SPRING.replace("deadzone( y , b )", "deadzone( y - b/2 , b )")
    );
    let factor = edited("k", "k + 2*k").expect("valid");
    assert_eq!(factor, SPRING.replace("1/2*k*", "1/2*(k + 2*k)*"));
}

#[test]
fn missing_targets_have_specific_errors() {
    let substitute = |section, term, find| {
        Edit::Substitute(Substitution {
            section,
            terms: vec![text(term)],
            find: text(find),
            replace: text("y"),
        })
    };
    let failed = |edit| apply(&source(), &[edit]).expect_err("no such place");
    let missing = failed(substitute(Section::Potential, "mesh_sp", "y"));
    assert!(
        matches!(missing, EditError::MissingTerm { .. }),
        "{missing}"
    );
    let missing = failed(substitute(Section::Forces, "spring", "y"));
    assert!(
        matches!(missing, EditError::MissingTerm { .. }),
        "{missing}"
    );
    let missing = failed(substitute(Section::Potential, "spring", "deadzone(z, b)"));
    assert!(
        matches!(missing, EditError::MissingExpression { .. }),
        "{missing}"
    );
    let unreadable = failed(substitute(Section::Potential, "spring", "deadzone(y"));
    assert!(
        matches!(unreadable, EditError::Expression { .. }),
        "{unreadable}"
    );
}

#[test]
fn edits_to_an_invalid_model_are_rejected() {
    let failed = |edits: &[Edit]| apply(&source(), edits).expect_err("no model");
    let taken = failed(&[parameter(), parameter()]);
    assert!(matches!(taken, EditError::NameTaken { .. }), "{taken}");
    let unknown = failed(&[force()]);
    assert!(
        unknown.to_string().contains("unknown name `T_c`"),
        "{unknown}"
    );
    let nan = Edit::AddParameter(NewParameter {
        name: text("T_c"),
        value: NewValue::Number(f64::NAN),
        unit: text("N"),
        doc: String::new(),
        source: String::new(),
    });
    let refused = failed(&[nan]);
    assert!(matches!(refused, EditError::NotFinite { .. }), "{refused}");
    let broken = apply(&Source::new("a.toml", "[model"), &[]).expect_err("no TOML");
    assert!(matches!(broken, EditError::Invalid(_)), "{broken}");
}

#[test]
fn empty_list_of_edits_keeps_the_bytes() {
    assert_eq!(apply(&source(), &[]).expect("valid"), SPRING);
}

#[test]
fn line_ends_and_byte_order_mark_are_kept() {
    let windows = format!("\u{feff}{}", SPRING.replace('\n', "\r\n"));
    let source = Source::new("spring.toml", windows.as_str());
    assert_eq!(apply(&source, &[]).expect("valid"), windows);
    let edited = apply(&source, &[parameter(), force()]).expect("valid");
    assert_eq!(edited.matches('\n').count(), edited.matches("\r\n").count());
    let plain = edited.replace('\r', "");
    assert_eq!(added_lines(plain.trim_start_matches('\u{feff}')).len(), 4);
}

#[test]
fn range_keeps_its_layout() {
    let text = SPRING.replace(
        "y = { unit = \"m\" }",
        "y = { unit = \"m\", range = [ \"-2*b\", 0.02 ] }   # the stops",
    );
    let source = Source::new("spring.toml", text.clone());
    let edited = apply(&source, &[parameter(), force()]).expect("valid");
    assert!(edited.contains("range = [ \"-2*b\", 0.02 ] }   # the stops"));
}
