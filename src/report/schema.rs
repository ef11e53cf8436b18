//! JSON Schemas of the documents, made of the types that are written.

use super::comparison::ComparisonDocument;
use super::explanation::ExplanationDocument;
use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use schemars::{JsonSchema, Schema};
use serde_json::{Value, json};

/// A verb, and how the schema of its document is made.
type Document = (&'static str, fn() -> Schema);

/// Documents by the verb that writes them.
const DOCUMENTS: [Document; 2] =
    [("compare", schema_of::<ComparisonDocument>), ("explain", schema_of::<ExplanationDocument>)];

/// The verbs whose documents have a schema.
pub fn verbs_with_schema() -> impl Iterator<Item = &'static str> {
    DOCUMENTS.iter().map(|(verb, _)| *verb)
}

/// The JSON Schema (draft 2020-12) of the document that a verb writes; `None` where it has none.
#[must_use]
pub fn document_schema(verb: &str) -> Option<Value> {
    let (_, schema) = DOCUMENTS.iter().find(|(known, _)| *known == verb)?;
    let mut schema = schema();
    schema.insert("title".to_owned(), json!(format!("mavid {verb}")));
    Some(schema.into())
}

fn schema_of<T: JsonSchema>() -> Schema {
    let settings = SchemaSettings::draft2020_12().for_serialize();
    settings.with_transform(RecursiveTransform(nullable)).into_generator().into_root_schema_for::<T>()
}

/// What is no number (infinite, not known) is written as null.
fn nullable(schema: &mut Schema) {
    if schema.get("type") == Some(&json!("number")) {
        schema.insert("type".to_owned(), json!(["number", "null"]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_schema_lists_every_key_and_says_which_are_always_there() {
        for verb in verbs_with_schema() {
            let schema = document_schema(verb).unwrap();
            assert_eq!(schema["properties"]["schema"]["const"], 1, "{verb}");
            let required = schema["required"].as_array().unwrap();
            assert!(required.contains(&json!("verdict")) && required.contains(&json!("answer")), "{verb}");
        }
        let compare = document_schema("compare").unwrap();
        assert_eq!(compare["$defs"]["Estimate"]["properties"]["value"]["type"], json!(["number", "null"]));
        assert_eq!(document_schema("fly"), None);
    }
}
