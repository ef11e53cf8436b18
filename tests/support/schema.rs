//! Whether a JSON document is as its schema says, by the keywords that the program's schemas have.

use serde_json::Value;

/// Says where a document differs from a schema; empty: nowhere. A keyword that is not known here is an error, too.
pub fn differences(document: &Value, schema: &Value) -> Vec<String> {
    let mut found = Vec::new();
    Checker { root: schema, found: &mut found }.check(document, schema, "$");
    found
}

struct Checker<'a> {
    root: &'a Value,
    found: &'a mut Vec<String>,
}

impl Checker<'_> {
    fn check(&mut self, value: &Value, schema: &Value, at: &str) {
        let Some(keywords) = schema.as_object() else { return };
        for (keyword, wanted) in keywords {
            self.keyword(value, (keyword, wanted), at);
        }
        // a key that no schema names would be a key that no reader knows
        if let (Some(known), Some(object)) = (schema.get("properties"), value.as_object()) {
            let unknown = object.keys().filter(|key| known.get(key).is_none());
            self.found.extend(unknown.map(|key| format!("{at}: {key} is not in the schema")));
        }
    }

    fn keyword(&mut self, value: &Value, (keyword, wanted): (&str, &Value), at: &str) {
        let is_right = match keyword {
            "$ref" => {
                let name = wanted.as_str().unwrap().strip_prefix("#/$defs/").unwrap();
                let schema = &self.root["$defs"][name];
                return self.check(value, schema, at);
            }
            "properties" => {
                for (key, schema) in wanted.as_object().unwrap() {
                    if let Some(value) = value.get(key) {
                        self.check(value, schema, &format!("{at}.{key}"));
                    }
                }
                true
            }
            "additionalProperties" => {
                for (key, value) in value.as_object().into_iter().flatten() {
                    self.check(value, wanted, &format!("{at}.{key}"));
                }
                true
            }
            "items" => {
                for (place, value) in value.as_array().into_iter().flatten().enumerate() {
                    self.check(value, wanted, &format!("{at}[{place}]"));
                }
                true
            }
            "prefixItems" => {
                let parts = value.as_array().into_iter().flatten().zip(wanted.as_array().unwrap());
                for (place, (value, schema)) in parts.enumerate() {
                    self.check(value, schema, &format!("{at}[{place}]"));
                }
                true
            }
            "anyOf" | "oneOf" => wanted.as_array().unwrap().iter().any(|schema| {
                let mut found = Vec::new();
                Checker { root: self.root, found: &mut found }.check(value, schema, at);
                found.is_empty()
            }),
            "type" => match wanted {
                Value::String(name) => is_of(value, name),
                names => names.as_array().unwrap().iter().any(|name| is_of(value, name.as_str().unwrap())),
            },
            "required" => {
                let has = |key: &Value| value.get(key.as_str().unwrap()).is_some();
                !value.is_object() || wanted.as_array().unwrap().iter().all(has)
            }
            "enum" => wanted.as_array().unwrap().contains(value),
            "const" => wanted == value,
            "minimum" => value.as_f64().is_none_or(|value| value >= wanted.as_f64().unwrap()),
            "minItems" => value.as_array().is_none_or(|value| value.len() as u64 >= wanted.as_u64().unwrap()),
            "maxItems" => value.as_array().is_none_or(|value| value.len() as u64 <= wanted.as_u64().unwrap()),
            "$schema" | "$defs" | "title" | "description" | "format" => true,
            _ => false,
        };
        if !is_right {
            self.found.push(format!("{at}: {keyword} {wanted} does not hold for {value}"));
        }
    }
}

fn is_of(value: &Value, name: &str) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        "integer" => value.is_i64() || value.is_u64(),
        "number" => value.is_number(),
        _ => false,
    }
}
